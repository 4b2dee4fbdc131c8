#include "compressor/encode/leaf_record.h"

#include <algorithm>
#include <cstring>

#include "format/base/simd.h"
#include "format/nanovdb/macrocells.h"

namespace weir {
namespace {

static_assert(kMacrocell == 2 * kLeafDim && kMacrocellApron == 1,
              "a leaf must face out of its macrocell on exactly one side of each axis, by one layer");

// The layer [lo, hi) of the leaf along one axis that faces out of the macrocell.
struct Layer {
  std::int64_t lo;
  std::int64_t hi;
};

Layer outward_layer(std::int64_t node_lo) {
  const bool up = floor_div(node_lo, kLeafDim) % 2 != 0;
  return up ? Layer{kLeafDim - 1, kLeafDim} : Layer{0, 1};
}

// The minimum and the maximum of several rows along z, voxel by voxel.
struct RowBounds {
  Floats8 min;
  Floats8 max;
};

[[gnu::always_inline]] inline void widen_rows(RowBounds& bounds, const Floats8& row) {
  bounds.min = row < bounds.min ? row : bounds.min;
  bounds.max = row > bounds.max ? row : bounds.max;
}

MinMax all_of(const RowBounds& rows) {
  MinMax bounds = kNoBounds;
  for (int z = 0; z < kLeafDim; ++z) widen(bounds, {rows.min[z], rows.max[z]});
  return bounds;
}

// The voxel layer, 0 or 7 along each axis, with which a leaf faces out of its macrocell.
struct Sides {
  std::size_t x;
  std::size_t y;
  std::size_t z;
};

// Bounds of the rows in the outward x layer, in the outward y layer, in the edge of both, and in the whole leaf.
struct LayerRows {
  RowBounds x;
  RowBounds y;
  RowBounds xy;
  RowBounds all;
};

WEIR_SIMD void bound_rows(const float* values, const Sides& sides, LayerRows& layers) {
  const Floats8 zero{};
  const RowBounds none{kNoBounds.min - zero, kNoBounds.max - zero};
  LayerRows l{none, none, none, none};
  for (std::size_t x = 0; x < 8; ++x) {
    for (std::size_t y = 0; y < 8; ++y) {
      Floats8 row;
      std::memcpy(&row, values + 64 * x + 8 * y, sizeof row);
      widen_rows(l.all, row);
      if (x == sides.x) widen_rows(l.x, row);
      if (y == sides.y) widen_rows(l.y, row);
      if (x == sides.x && y == sides.y) widen_rows(l.xy, row);
    }
  }
  layers = l;
}

// Finds the bounds of the outward layers of a leaf that lies wholly inside the domain.
void bound_layers(const LeafValues& values, const Sides& sides, std::array<MinMax, 7>& outward) {
  LayerRows layers;
  bound_rows(values.data(), sides, layers);
  const auto at_z = [&](const RowBounds& rows) {
    MinMax bounds = kNoBounds;
    widen(bounds, {rows.min[static_cast<int>(sides.z)], rows.max[static_cast<int>(sides.z)]});
    return bounds;
  };
  outward = {all_of(layers.x), all_of(layers.y), all_of(layers.xy), at_z(layers.all),
             at_z(layers.x),   at_z(layers.y),   at_z(layers.xy)};
}

}  // namespace

LeafRecord make_leaf_record(const LeafValues& values, const Box& node, const Box& inside,
                            const NodeStatistics& statistics) {
  LeafRecord record;
  record.mean = statistics.mean;
  record.m2 = statistics.m2;
  widen(record.bounds, {statistics.min, statistics.max});
  if (inside == node) {
    const auto side = [](std::int64_t lo) { return static_cast<std::size_t>(outward_layer(lo).lo); };
    bound_layers(values, {side(node.lo.x), side(node.lo.y), side(node.lo.z)}, record.outward);
    return record;
  }
  const Box active{inside.lo - node.lo, inside.hi - node.lo};
  const Layer x_layer = outward_layer(node.lo.x);
  const Layer y_layer = outward_layer(node.lo.y);
  const Layer z_layer = outward_layer(node.lo.z);
  for (unsigned d = 1; d < 8; ++d) {
    Box layer{{0, 0, 0}, {kLeafDim, kLeafDim, kLeafDim}};
    if ((d & 1U) != 0) layer.lo.x = x_layer.lo, layer.hi.x = x_layer.hi;
    if ((d & 2U) != 0) layer.lo.y = y_layer.lo, layer.hi.y = y_layer.hi;
    if ((d & 4U) != 0) layer.lo.z = z_layer.lo, layer.hi.z = z_layer.hi;
    layer = intersect(layer, active);
    MinMax bounds = kNoBounds;
    for (std::int64_t x = layer.lo.x; x < layer.hi.x; ++x) {
      for (std::int64_t y = layer.lo.y; y < layer.hi.y; ++y) {
        for (std::int64_t z = layer.lo.z; z < layer.hi.z; ++z) {
          const float v = values[static_cast<std::size_t>(x << 6 | y << 3 | z)];
          if (v < bounds.min) bounds.min = v;
          if (v > bounds.max) bounds.max = v;
        }
      }
    }
    record.outward[d - 1] = bounds;
  }
  return record;
}

void set_active(LeafRecord& record, const LeafMask& mask, const Box& node, const Box& inside,
                const NodeStatistics& statistics) {
  const auto byte = [](std::int64_t i) { return static_cast<std::uint8_t>(i); };
  const Box box{statistics.bbox.lo - node.lo, statistics.bbox.hi - node.lo};
  record.mean = statistics.mean;
  record.m2 = statistics.m2;
  widen(record.active, {statistics.min, statistics.max});
  record.inactive = static_cast<std::uint16_t>(inside.voxels() - static_cast<std::int64_t>(mask.count()));
  record.active_lo = {byte(box.lo.x), byte(box.lo.y), byte(box.lo.z)};
  record.active_end = {byte(box.hi.x), byte(box.hi.y), byte(box.hi.z)};
}

NodeStatistics active_statistics(const LeafRecord& record, const Box& node, const Box& inside) {
  NodeStatistics statistics;
  const MinMax& bounds = record.inactive == 0 ? record.bounds : record.active;
  statistics.min = std::min(statistics.min, bounds.min);
  statistics.max = std::max(statistics.max, bounds.max);
  statistics.mean = record.mean;
  statistics.m2 = record.m2;
  statistics.count = static_cast<std::uint64_t>(inside.voxels() - record.inactive);
  statistics.bbox = inside;
  if (record.inactive == 0) return statistics;
  const auto& [x, y, z] = record.active_lo;
  const auto& [end_x, end_y, end_z] = record.active_end;
  statistics.bbox = {node.lo + Index3{x, y, z}, node.lo + Index3{end_x, end_y, end_z}};
  return statistics;
}

}  // namespace weir
