// Levels of detail over a volume's domain: a texel of level l is the mean of 2^l voxels along each axis. Cubes begin at
// multiples of their edge from the corner of the domain's first region (block_lattice.h). For host and device.
#pragma once

#include <cstdint>
#include <limits>

#include "gpu/math/vector3.h"

namespace weir {

/// Levels that a picture can have.
inline constexpr int kMostLevels = 16;

struct LevelLattice {
  Int3 shift;   ///< voxels from the first region's corner to the domain's
  Int3 extent;  ///< voxels of the domain

  /// The first texel of a level, counted from the first region's corner.
  WEIR_HOST_DEVICE Int3 first(int level) const { return {shift.x >> level, shift.y >> level, shift.z >> level}; }
  /// Along each axis.
  WEIR_HOST_DEVICE Int3 texels(int level) const {
    return {texels(shift.x, extent.x, level), texels(shift.y, extent.y, level), texels(shift.z, extent.z, level)};
  }
  WEIR_HOST_DEVICE std::uint64_t size(int level) const {
    const Int3 n = texels(level);
    return static_cast<std::uint64_t>(n.x) * static_cast<std::uint64_t>(n.y) * static_cast<std::uint64_t>(n.z);
  }
  /// Voxels of the domain in texel `i` of a level, counted from the level's first: [low, high) from the first region's
  /// corner.
  WEIR_HOST_DEVICE void voxels(const Int3& i, int level, Int3& low, Int3& high) const {
    const Int3 f = first(level);
    low = {greater((f.x + i.x) << level, shift.x), greater((f.y + i.y) << level, shift.y),
           greater((f.z + i.z) << level, shift.z)};
    high = {lesser((f.x + i.x + 1) << level, shift.x + extent.x), lesser((f.y + i.y + 1) << level, shift.y + extent.y),
            lesser((f.z + i.z + 1) << level, shift.z + extent.z)};
  }
  /// Where a position (voxels from the domain's lowest corner) lies in a level, in texels from its first.
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

/// Levels from `first` to the one of a single texel, kMostLevels at most.
WEIR_HOST_DEVICE inline int level_count(const LevelLattice& lattice, int first) {
  int count = 1;
  while (count < kMostLevels && lattice.size(first + count - 1) > 1) ++count;
  return count;
}

/// Bytes of the texels of all of them.
std::uint64_t level_bytes(const LevelLattice& lattice, int first);

/// Levels above this have their texels made from finer ones.
inline constexpr int kMostFinest = 5;

/// The finest level from `wanted` on, at least 1 and at most kMostFinest, whose texels and those of all coarser ones
/// take at most `bytes`, at most `longest` of them along an axis; 0 where there is none.
int finest_level_within(const LevelLattice& lattice, int wanted, std::uint64_t bytes,
                        std::int32_t longest = std::numeric_limits<std::int32_t>::max());

}  // namespace weir
