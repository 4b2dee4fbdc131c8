#include "format/leaf/leaf_codec.h"

#include <algorithm>
#include <cstring>

#include "format/base/little_endian.h"
#include "format/base/simd.h"
#include "format/leaf/leaf_head.h"

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

// Transposes 8 x 8 values: row i of `from`, `stride` apart, becomes column i of `to`, whose rows are 64 apart.
WEIR_SIMD void transpose(const float* from, std::int64_t stride, float* to) {
  std::array<Floats8, 8> rows;
  for (std::size_t i = 0; i < 8; ++i) {
    std::memcpy(&rows[i], from + static_cast<std::int64_t>(i) * stride, sizeof(Floats8));
  }
  std::array<Floats8, 8> pairs;
  for (std::size_t i = 0; i < 8; i += 2) {
    pairs[i] = __builtin_shufflevector(rows[i], rows[i + 1], 0, 8, 1, 9, 4, 12, 5, 13);
    pairs[i + 1] = __builtin_shufflevector(rows[i], rows[i + 1], 2, 10, 3, 11, 6, 14, 7, 15);
  }
  std::array<Floats8, 8> fours;
  for (std::size_t i = 0; i < 8; i += 4) {
    for (std::size_t k = 0; k < 2; ++k) {
      fours[i + 2 * k] = __builtin_shufflevector(pairs[i + k], pairs[i + k + 2], 0, 1, 8, 9, 4, 5, 12, 13);
      fours[i + 2 * k + 1] = __builtin_shufflevector(pairs[i + k], pairs[i + k + 2], 2, 3, 10, 11, 6, 7, 14, 15);
    }
  }
  for (std::size_t i = 0; i < 4; ++i) {
    const Floats8 low = __builtin_shufflevector(fours[i], fours[i + 4], 0, 1, 2, 3, 8, 9, 10, 11);
    const Floats8 high = __builtin_shufflevector(fours[i], fours[i + 4], 4, 5, 6, 7, 12, 13, 14, 15);
    std::memcpy(to + 64 * i, &low, sizeof low);
    std::memcpy(to + 64 * (i + 4), &high, sizeof high);
  }
}

}  // namespace

void gather_leaf(std::span<const float> values, const Box& box, const Box& node, const Box& inside, float outside,
                 LeafValues& leaf) {
  const Index3 extent = box.extent();
  if (inside == node) {
    const float* corner = values.data() + linear_index(inside.lo - box.lo, extent);
    for (std::int64_t y = 0; y < kLeafDim; ++y) {  // rows along x in, rows along z out
      transpose(corner + extent.x * y, extent.x * extent.y, leaf.data() + (y << 3));
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

NodeStatistics leaf_statistics(const LeafValues& values, const Box& node, const LeafMask& mask) {
  NodeStatistics statistics;
  for (std::size_t n = 0; n < mask.size(); ++n) {
    if (mask[n]) statistics.add(values[n]);
  }
  statistics.add_box(box_of(mask, node));
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
