#include "format/leaf/leaf_codec.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "format/base/little_endian.h"
#include "format/base/simd.h"
#include "format/base/transpose_lanes.h"
#include "format/leaf/leaf_head.h"

namespace weir {
namespace {

using Floats4 = float __attribute__((vector_size(16)));
using Doubles4 = double __attribute__((vector_size(32)));

// NodeStatistics::add() for kLeafBatch leaves side by side, four to a vector, a width that most machines have.
constexpr std::size_t kFours = kLeafBatch / 4;

struct BatchStatistics {
  std::array<Floats4, kFours> min;
  std::array<Floats4, kFours> max;
  std::array<Doubles4, kFours> mean;
  std::array<Doubles4, kFours> m2;
};

[[gnu::always_inline]] inline void add_four(const Floats4& value, double count, std::size_t four, BatchStatistics& s) {
  s.min[four] = value < s.min[four] ? value : s.min[four];
  s.max[four] = value > s.max[four] ? value : s.max[four];
  const Doubles4 wide = __builtin_convertvector(value, Doubles4);
  const Doubles4 delta = wide - s.mean[four];
  s.mean[four] += delta / count;
  s.m2[four] += delta * (wide - s.mean[four]);
}

WEIR_SIMD void add_side_by_side(const float* values, BatchStatistics& batch) {
  BatchStatistics s = batch;
  for (std::size_t first = 0; first < kLeafVoxels; first += 8) {
    Floats8 next[kLeafBatch / 8][8];
    for (std::size_t v = 0; v < kLeafBatch / 8; ++v) {
      for (std::size_t l = 0; l < 8; ++l) {
        load_lanes(values + (8 * v + l) * kLeafVoxels + first, next[v][l]);
      }
      transpose_8(next[v]);  // a lane for each leaf
    }
    for (std::size_t i = 0; i < 8; ++i) {
      const auto count = static_cast<double>(first + i + 1);
      for (std::size_t v = 0; v < kLeafBatch / 8; ++v) {
        const Floats8 value = next[v][i];
        add_four(__builtin_shufflevector(value, value, 0, 1, 2, 3), count, 2 * v, s);
        add_four(__builtin_shufflevector(value, value, 4, 5, 6, 7), count, 2 * v + 1, s);
      }
    }
  }
  batch = s;
}

// Transposes 8 x 8 values. Rows of `from` are `stride` apart, rows of `to` 64; row i of `from` becomes column i of
// `to`.
WEIR_SIMD void transpose(const float* from, std::int64_t stride, float* to) {
  Floats8 rows[8];
  for (std::size_t i = 0; i < 8; ++i) {
    load_lanes(from + static_cast<std::int64_t>(i) * stride, rows[i]);
  }
  transpose_8(rows);
  for (std::size_t i = 0; i < 8; ++i) store_lanes(rows[i], to + 64 * i);
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
  batch.min.fill(fresh.min - Floats4{});
  batch.max.fill(fresh.max - Floats4{});
  if (leaves.size() == kLeafBatch) {
    add_side_by_side(leaves.front().data(), batch);
  } else {
    std::array<LeafValues, kLeafBatch> padded{};
    std::copy(leaves.begin(), leaves.end(), padded.begin());
    add_side_by_side(padded.front().data(), batch);
  }
  for (std::size_t l = 0; l < leaves.size(); ++l) {
    const std::size_t v = l / 4;
    const std::size_t lane = l % 4;
    statistics[l] = NodeStatistics{batch.min[v][lane], batch.max[v][lane], batch.mean[v][lane],
                                   batch.m2[v][lane],  kLeafVoxels,        nodes[l]};
    // Machines return the first of two NaN that are added; the lanes add them in another order.
    if (!std::isfinite(batch.mean[v][lane])) statistics[l] = leaf_statistics(leaves[l], nodes[l], nodes[l]);
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
