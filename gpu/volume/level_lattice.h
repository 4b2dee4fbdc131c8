// Levels of detail over a volume's domain: a texel of level l is the mean of 2^l voxels along each axis. Its cube
// begins at a multiple of its edge, counted from the corner of the domain's first region (block_lattice.h). For host
// and device.
#pragma once

#include <cstdint>
#include <limits>

#include "gpu/math/vector3.h"

namespace weir {

/// Most levels that a picture can have.
inline constexpr int kMostLevels = 16;

struct LevelLattice {
  Int3 shift;   ///< voxels from the first region's corner to the domain's
  Int3 extent;  ///< voxels of the domain

  /// Returns the first texel of a level, counted from the first region's corner.
  WEIR_HOST_DEVICE Int3 first(int level) const { return {shift.x >> level, shift.y >> level, shift.z >> level}; }
  /// Returns the texels of a level along each axis.
  WEIR_HOST_DEVICE Int3 texels(int level) const {
    return {texels(shift.x, extent.x, level), texels(shift.y, extent.y, level), texels(shift.z, extent.z, level)};
  }
  WEIR_HOST_DEVICE std::uint64_t size(int level) const {
    const Int3 n = texels(level);
    return static_cast<std::uint64_t>(n.x) * static_cast<std::uint64_t>(n.y) * static_cast<std::uint64_t>(n.z);
  }
  /// Sets the voxels [low, high) of the domain in texel `i` of a level, counted from the first region's corner. `i`
  /// counts from the level's first texel.
  WEIR_HOST_DEVICE void voxels(const Int3& i, int level, Int3& low, Int3& high) const {
    const Int3 f = first(level);
    low = {greater((f.x + i.x) << level, shift.x), greater((f.y + i.y) << level, shift.y),
           greater((f.z + i.z) << level, shift.z)};
    high = {lesser((f.x + i.x + 1) << level, shift.x + extent.x), lesser((f.y + i.y + 1) << level, shift.y + extent.y),
            lesser((f.z + i.z + 1) << level, shift.z + extent.z)};
  }
  /// Returns where a position (voxels from the domain's lowest corner) lies in a level, in texels from the level's
  /// first.
  WEIR_HOST_DEVICE Float3 position(const Float3& p, int level) const {
    const float scale = 1.0F / static_cast<float>(1 << level);
    const Int3 f = first(level);
    return {multiply_add(p.x + static_cast<float>(shift.x), scale, static_cast<float>(-f.x)),
            multiply_add(p.y + static_cast<float>(shift.y), scale, static_cast<float>(-f.y)),
            multiply_add(p.z + static_cast<float>(shift.z), scale, static_cast<float>(-f.z))};
  }

 private:
  WEIR_HOST_DEVICE static std::int32_t texels(std::int32_t shift, std::int32_t extent, int level) {
    return ((shift + extent - 1) >> level) - (shift >> level) + 1;
  }
};

/// Returns the number of levels from `first` to the level of a single texel, at most kMostLevels.
WEIR_HOST_DEVICE inline int level_count(const LevelLattice& lattice, int first) {
  int count = 1;
  while (count < kMostLevels && lattice.size(first + count - 1) > 1) ++count;
  return count;
}

/// Returns the bytes of the texels of all levels from `first` on.
std::uint64_t level_bytes(const LevelLattice& lattice, int first);

/// The coarsest level that can be made from voxels. Coarser levels are always made from finer ones.
inline constexpr int kMostFinest = 5;

/// Returns the finest level from `wanted` on, in [1, kMostFinest], for which it and all coarser levels take at most
/// `bytes` and it has at most `longest` texels along an axis. Returns 0 if there is none.
int finest_level_within(const LevelLattice& lattice, int wanted, std::uint64_t bytes,
                        std::int32_t longest = std::numeric_limits<std::int32_t>::max());

}  // namespace weir
