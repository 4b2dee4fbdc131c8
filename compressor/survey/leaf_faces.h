// Bounds of the values in the outer layers of a leaf: what a neighbour's lookups
// can touch of it.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "format/base/index.h"
#include "format/leaf/bounds.h"

namespace weir {

struct LeafFaces {
  /// By direction, (x + 1) + 3 (y + 1) + 9 (z + 1): of the finite values of that layer, edge or corner, min > max where
  /// there is none. The middle one is unused.
  std::array<MinMax, 27> bounds;

  /// What the leaf's neighbour in direction `toward` (-1, 0 or 1 along each axis, not all 0) touches.
  const MinMax& touched_from(const Index3& toward) const { return bounds[direction(toward)]; }
  static constexpr std::size_t direction(const Index3& toward) {
    return static_cast<std::size_t>(toward.x + 1 + 3 * (toward.y + 1) + 9 * (toward.z + 1));
  }
};
static_assert(sizeof(LeafFaces) == 216, "faces are spilled as they are");

/// Of the `extent` in-domain values of a leaf, x fastest.
LeafFaces faces_of(std::span<const float> values, const Index3& extent);

}  // namespace weir
