// A packed grid with known voxels, for the tests of all readers.
#pragma once

#include <array>

#include "tests/support/packed_grid.h"

namespace weir::test {

/// Has four regions along x; the second has no stream. In the other regions a third of the blocks is raw, a third is
/// constant and a third has the region's value. The domain cuts blocks at all faces.
struct PackedSample {
  static constexpr Box kDomain{{-5, 3, 10}, {260, 40, 61}};
  static constexpr float kBackground = 0.25F;

  static PackedFile build() {
    PackedGridOptions options;
    options.domain = kDomain;
    options.background = kBackground;
    options.stream = stream_of;
    options.value = region_value;
    return PackedGridBuilder::build(options);
  }

  static float value(const Index3& i) {
    if (!kDomain.contains(i)) return kBackground;
    const Index3 block = floor_div(i, kLeafDim);
    if (kind(block) == 2) return region_value(floor_div(i, kLowerDim));
    return kind(block) == 1 ? block_value(block) : voxel_value(i);
  }

  /// Returns the kind of a block: 0 raw, 1 constant, 2 without a stream.
  static int kind(const Index3& block) {
    return floor_div(block.x, kLowerLeaves) == 0 ? 2 : static_cast<int>((block.x + block.y + block.z + 30) % 3);
  }

  /// Returns the number of blocks that touch the domain, by kind.
  static std::array<std::uint64_t, 3> blocks_by_kind() {
    std::array<std::uint64_t, 3> count{};
    const NodeLattice blocks = make_lattice(kDomain, kLeafDim);
    for_each_index({blocks.first, blocks.first + blocks.count},
                   [&](const Index3& block) { ++count[static_cast<std::size_t>(kind(block))]; });
    return count;
  }

 private:
  static float voxel_value(const Index3& i) {
    return static_cast<float>(i.x + 3 * i.y) - 0.5F * static_cast<float>(i.z);
  }
  static float block_value(const Index3& block) { return static_cast<float>(block.x - block.y + 100 * block.z); }
  static float region_value(const Index3& region) { return static_cast<float>(region.x) + 0.125F; }

  static PackedBytes stream_of(const Index3& block) {
    if (kind(block) == 2) return {};
    if (kind(block) == 1) return constant_stream(block_value(block));
    std::array<float, kLeafVoxels> values;
    for (std::int64_t n = 0; n < kLeafVoxels; ++n) {
      values[static_cast<std::size_t>(n)] = voxel_value(block * kLeafDim + Index3{n >> 6, n >> 3 & 7, n & 7});
    }
    return raw_stream(values);
  }
};

}  // namespace weir::test
