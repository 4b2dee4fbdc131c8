// How the values of leaves repeat that are looked at several at once, one leaf a lane.
#pragma once

#include <cstddef>

#include "format/base/index.h"
#include "format/base/simd.h"

namespace weir {

/// Leaves side by side.
inline constexpr std::size_t kLeafLanes = 8;
/// Distinct values of one of them at most.
inline constexpr std::size_t kMostLaneValues = 128;

/// Groups of voxels with one value each, along the axes of a leaf.
struct LaneShape {
  std::size_t x = 1;  ///< 1, 2 or 4
  std::size_t y = 1;  ///< 1, 2 or 4
  std::size_t z = 1;  ///< 1, 2, 4 or 8

  /// Of groups of `by` voxels, which suit.
  static LaneShape of(const Index3& by) {
    const auto groups = [](std::int64_t each) { return static_cast<std::size_t>(kLeafDim / each); };
    return {groups(by.x), groups(by.y), groups(by.z)};
  }
  /// Rows and the pairs of them must repeat: of others the sums have as many terms as there are values.
  static bool suits(const Index3& by) { return by.x > 1 && by.y > 1; }

  std::size_t values() const { return x * y * z; }
  /// Voxels that have one of them.
  std::size_t times() const { return kLeafVoxels / values(); }
};

}  // namespace weir
