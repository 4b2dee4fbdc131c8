#include "compressor/leaf_record.h"

#include "format/macrocells.h"

namespace weir {
namespace {

static_assert(kMacrocell == 2 * kLeafDim && kMacrocellApron == 1,
              "a leaf must face out of its macrocell on exactly one side of each axis, by one layer");

// Layer [lo, hi) of one axis, in the leaf, that faces out of the macrocell.
struct Layer {
  std::int64_t lo;
  std::int64_t hi;
};

Layer outward_layer(std::int64_t node_lo) {
  const bool up = floor_div(node_lo, kLeafDim) % 2 != 0;
  return up ? Layer{kLeafDim - 1, kLeafDim} : Layer{0, 1};
}

}  // namespace

LeafRecord make_leaf_record(const LeafValues& values, const Box& node, const Box& inside,
                            const NodeStatistics& statistics) {
  LeafRecord record;
  record.mean = statistics.mean;
  record.m2 = statistics.m2;
  widen(record.bounds, {statistics.min, statistics.max});
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

}  // namespace weir
