// Makes levels of detail from decoded blocks, one batch of regions at a time. For host and device.
#pragma once

#include <cstdint>

#include "gpu/volume/block_lattice.h"
#include "gpu/volume/level_lattice.h"
#include "gpu/volume/voxel_mean.h"

namespace weir {

/// Lists the blocks of regions. A block outside the domain is replaced by the nearest block inside. Runs for each
/// block of each region.
struct ListRegionBlocks {
  BlockLattice lattice;
  const std::uint32_t* regions = nullptr;
  BlockId* blocks = nullptr;

  WEIR_HOST_DEVICE void operator()(std::uint32_t i) const {
    const BlockId id = static_cast<BlockId>(regions[i / kRegionBlocks]) * kRegionBlocks + i % kRegionBlocks;
    const Int3 block = lattice.block_at(id);
    const Int3 last = lattice.last_block();
    blocks[i] =
        lattice.id_of({clamped(block.x, lattice.shift.x >> 3, last.x), clamped(block.y, lattice.shift.y >> 3, last.y),
                       clamped(block.z, lattice.shift.z >> 3, last.z)});
  }
};

/// The finest level's texels in a list of regions.
struct RegionTexels {
  BlockLattice lattice;
  LevelLattice levels;
  int level = 1;  ///< at most kMostFinest
  const std::uint32_t* regions = nullptr;

  /// Returns the number of texels per region.
  WEIR_HOST_DEVICE static std::uint32_t count(int level) { return 1U << (3 * (7 - level)); }
  /// Finds the i-th of all texels, counted from the level's first. Returns false if it is outside the domain.
  WEIR_HOST_DEVICE bool at(std::uint32_t i, Int3& texel) const {
    const Int3 region = lattice.region_at(regions[i / count(level)]);
    const auto k = static_cast<std::int32_t>(i % count(level));
    const int bits = 7 - level;
    const std::int32_t mask = (1 << bits) - 1;
    const Int3 first = levels.first(level);
    const Int3 n = levels.texels(level);
    texel = {(region.x << bits) + (k & mask) - first.x, (region.y << bits) + (k >> bits & mask) - first.y,
             (region.z << bits) + (k >> 2 * bits) - first.z};
    return texel.x >= 0 && texel.y >= 0 && texel.z >= 0 && texel.x < n.x && texel.y < n.y && texel.z < n.z;
  }
};

/// Runs for each of RegionTexels. Uses the values of the regions' blocks in the order of ListRegionBlocks.
struct FillFinest {
  RegionTexels of;
  const float* values = nullptr;  ///< 512 per block
  float* texels = nullptr;

  WEIR_HOST_DEVICE void operator()(std::uint32_t i) const {
    Int3 texel;
    if (!of.at(i, texel)) return;
    Int3 low;
    Int3 high;
    of.levels.voxels(texel, of.level, low, high);
    const float* region = values + std::size_t{512} * kRegionBlocks * (i / RegionTexels::count(of.level));
    VoxelMean mean;
    for (std::int32_t x = low.x >> 3; 8 * x < high.x; ++x) {
      for (std::int32_t y = low.y >> 3; 8 * y < high.y; ++y) {
        for (std::int32_t z = low.z >> 3; 8 * z < high.z; ++z) {
          mean.add(region + std::size_t{512} * BlockLattice::position_of({x, y, z}),
                   {clamped(low.x - 8 * x, 0, 8), clamped(low.y - 8 * y, 0, 8), clamped(low.z - 8 * z, 0, 8)},
                   {clamped(high.x - 8 * x, 0, 8), clamped(high.y - 8 * y, 0, 8), clamped(high.z - 8 * z, 0, 8)});
        }
      }
    }
    texels[table_index(texel, of.levels.texels(of.level))] = mean.value();
  }
};

/// Runs for each of RegionTexels, for regions that have one value each.
struct FillFinestPlain {
  RegionTexels of;
  const float* values = nullptr;  ///< one per region
  float* texels = nullptr;

  WEIR_HOST_DEVICE void operator()(std::uint32_t i) const {
    Int3 texel;
    if (!of.at(i, texel)) return;
    VoxelMean mean;
    mean.add(values[i / RegionTexels::count(of.level)], 1);
    texels[table_index(texel, of.levels.texels(of.level))] = mean.value();
  }
};

/// Returns the i-th of `n` texels, x fastest.
WEIR_HOST_DEVICE inline Int3 texel_at(std::uint32_t i, const Int3& n) {
  const auto nx = static_cast<std::uint32_t>(n.x);
  const auto ny = static_cast<std::uint32_t>(n.y);
  return {static_cast<std::int32_t>(i % nx), static_cast<std::int32_t>(i / nx % ny),
          static_cast<std::int32_t>(i / nx / ny)};
}

/// Makes level `level` + 1. Runs for each of its texels.
struct FillCoarser {
  LevelLattice levels;
  int level = 1;
  const float* finer = nullptr;
  float* coarser = nullptr;

  WEIR_HOST_DEVICE void operator()(std::uint32_t i) const {
    coarser[i] = coarser_texel(levels, level, finer, texel_at(i, levels.texels(level + 1)));
  }
};

/// Writes planes of a level's texels as look-ups read them. Runs for each texel of these. `Out` has write(texel,
/// value).
template <class Out>
struct WritePlanes {
  Int3 size;  ///< of the level
  const float* texels = nullptr;
  std::int32_t first_plane = 0;
  Out out;

  WEIR_HOST_DEVICE void operator()(std::uint32_t i) const {
    Int3 texel = texel_at(i, size);
    texel.z += first_plane;
    out.write(texel, texel_beside_finite(texels, size, texel));
  }
};

}  // namespace weir
