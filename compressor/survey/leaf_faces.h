// Bounds of the values in the outer layers of a leaf. Lookups in a neighbouring leaf can touch only these layers.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "format/base/index.h"
#include "format/leaf/bounds.h"

namespace weir {

struct LeafFaces {
  /// Bounds of the finite values of the layer, edge or corner in each direction, at index direction(). min > max if
  /// there is no finite value. The entry in the middle is unused.
  std::array<MinMax, 27> bounds;

  /// Returns the bounds of the values that the neighbour in direction `toward` touches. `toward` is -1, 0 or 1 along
  /// each axis, and not 0 along all.
  const MinMax& touched_from(const Index3& toward) const { return bounds[direction(toward)]; }
  static constexpr std::size_t direction(const Index3& toward) {
    return static_cast<std::size_t>(toward.x + 1 + 3 * (toward.y + 1) + 9 * (toward.z + 1));
  }
};
static_assert(sizeof(LeafFaces) == 216, "faces are spilled as they are");

/// Returns the faces of a leaf. `values` are its `extent` in-domain values, x fastest.
LeafFaces faces_of(std::span<const float> values, const Index3& extent);

}  // namespace weir
