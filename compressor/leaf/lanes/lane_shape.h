// The pattern in which values repeat in leaves that are processed several at once, one leaf per lane.
#pragma once

#include <cstddef>

#include "format/base/index.h"
#include "format/base/simd.h"

namespace weir {

/// The number of leaves that are processed side by side.
inline constexpr std::size_t kLeafLanes = 8;
/// The most distinct values of one leaf.
inline constexpr std::size_t kMostLaneValues = 128;

/// The number of groups along each axis of a leaf; all voxels of a group have one value.
struct LaneShape {
  std::size_t x = 1;  ///< 1, 2 or 4
  std::size_t y = 1;  ///< 1, 2 or 4
  std::size_t z = 1;  ///< 1, 2, 4 or 8

  /// Returns the shape for groups of `by` voxels. suits(by) must be true.
  static LaneShape of(const Index3& by) {
    const auto groups = [](std::int64_t each) { return static_cast<std::size_t>(kLeafDim / each); };
    return {groups(by.x), groups(by.y), groups(by.z)};
  }
  /// Returns whether groups of `by` voxels can be processed in lanes. Values must repeat along rows and in pairs of
  /// rows; otherwise the sums have as many terms as there are values.
  static bool suits(const Index3& by) { return by.x > 1 && by.y > 1; }

  std::size_t values() const { return x * y * z; }
  /// Returns the number of voxels that share one value.
  std::size_t times() const { return kLeafVoxels / values(); }
};

}  // namespace weir
