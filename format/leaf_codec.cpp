#include "format/leaf_codec.h"

#include <algorithm>
#include <cstring>

#include "format/leaf_head.h"
#include "format/little_endian.h"
#include "format/simd.h"

namespace weir {
namespace {

// NodeStatistics::add for kLeafBatch leaves side by side.
struct BatchStatistics {
  std::array<float, kLeafBatch> min;
  std::array<float, kLeafBatch> max;
  std::array<double, kLeafBatch> mean;
  std::array<double, kLeafBatch> m2;
};

WEIR_SIMD void add_side_by_side(const float* values, BatchStatistics& batch) {
  BatchStatistics s = batch;
  for (std::size_t i = 0; i < kLeafVoxels; ++i) {
    const auto count = static_cast<double>(i + 1);
    for (std::size_t l = 0; l < kLeafBatch; ++l) {
      const float value = values[l * kLeafVoxels + i];
      s.min[l] = value < s.min[l] ? value : s.min[l];
      s.max[l] = value > s.max[l] ? value : s.max[l];
      const double delta = static_cast<double>(value) - s.mean[l];
      s.mean[l] += delta / count;
      s.m2[l] += delta * (static_cast<double>(value) - s.mean[l]);
    }
  }
  batch = s;
}

}  // namespace

void gather_leaf(std::span<const float> values, const Box& box, const Box& node, const Box& inside, float outside,
                 LeafValues& leaf) {
  const Index3 extent = box.extent();
  if (inside == node) {
    const float* corner = values.data() + linear_index(inside.lo - box.lo, extent);
    for (std::int64_t y = 0; y < kLeafDim; ++y) {
      for (std::int64_t z = 0; z < kLeafDim; ++z) {
        const float* row = corner + extent.x * (y + extent.y * z);
        for (std::int64_t x = 0; x < kLeafDim; ++x) leaf[static_cast<std::size_t>(x << 6 | y << 3 | z)] = row[x];
      }
    }
    return;
  }
  leaf.fill(outside);
  for (std::int64_t z = inside.lo.z; z < inside.hi.z; ++z) {
    for (std::int64_t y = inside.lo.y; y < inside.hi.y; ++y) {
      const float* row = values.data() + linear_index(Index3{inside.lo.x, y, z} - box.lo, extent);
      for (std::int64_t x = inside.lo.x; x < inside.hi.x; ++x) {
        const Index3 i = Index3{x, y, z} - node.lo;
        leaf[static_cast<std::size_t>(i.x << 6 | i.y << 3 | i.z)] = row[x - inside.lo.x];
      }
    }
  }
}

NodeStatistics leaf_statistics(const LeafValues& values, const Box& node, const Box& inside) {
  NodeStatistics statistics;
  const Index3 lo = inside.lo - node.lo;
  const Index3 hi = inside.hi - node.lo;
  for (std::int64_t x = lo.x; x < hi.x; ++x) {
    for (std::int64_t y = lo.y; y < hi.y; ++y) {
      const float* row = values.data() + (x << 6 | y << 3);
      for (std::int64_t z = lo.z; z < hi.z; ++z) statistics.add(row[z]);
    }
  }
  statistics.add_box(inside);
  return statistics;
}

void full_leaf_statistics(std::span<const LeafValues> leaves, std::span<const Box> nodes,
                          std::span<NodeStatistics> statistics) {
  const NodeStatistics fresh;
  BatchStatistics batch{};
  batch.min.fill(fresh.min);
  batch.max.fill(fresh.max);
  if (leaves.size() == kLeafBatch) {
    add_side_by_side(leaves.front().data(), batch);
  } else {
    std::array<LeafValues, kLeafBatch> padded{};
    std::copy(leaves.begin(), leaves.end(), padded.begin());
    add_side_by_side(padded.front().data(), batch);
  }
  for (std::size_t l = 0; l < leaves.size(); ++l) {
    statistics[l] = NodeStatistics{batch.min[l], batch.max[l], batch.mean[l], batch.m2[l], kLeafVoxels, nodes[l]};
  }
}

void encode_float_leaf(const LeafValues& values, const Box& node, const Box& inside, const NodeStatistics& statistics,
                       std::span<std::byte, nvdb::kFloatLeafBytes> image) {
  using namespace nvdb::leaf;
  write_leaf_head(node, inside, 0, image);
  store(image, kMin, statistics.min);
  store(image, kMax, statistics.max);
  store(image, kAverage, statistics.average());
  store(image, kStdDev, statistics.deviation());
  std::memcpy(image.data() + kValues, values.data(), sizeof(LeafValues));
}

}  // namespace weir
