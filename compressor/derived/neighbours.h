// The pairs of voxels for the differences at a voxel: central differences, and at the faces of the volume differences
// to the next voxel, as numpy.gradient takes them.
#pragma once

#include <array>
#include <cstddef>

#include "compressor/compare/value_pair.h"

namespace weir {

/// The two voxels along an axis (ValuePair::at) and their distance in world units; 0 along an axis of one voxel.
struct Neighbours {
  std::size_t low;
  std::size_t high;
  double length;
};

/// Returns the neighbours of voxel `i` along x, y and z. `spacing` is in world units per voxel.
inline std::array<Neighbours, 3> neighbours_of(const ValuePair& values, const Index3& i,
                                               const std::array<double, 3>& spacing) {
  const auto along = [&](const Index3& step, bool at_low, bool at_high, double distance) {
    const int voxels = (at_low ? 0 : 1) + (at_high ? 0 : 1);
    return Neighbours{values.at(at_low ? i : i - step), values.at(at_high ? i : i + step), distance * voxels};
  };
  const Index3& first = values.domain.lo;
  const Index3 last = values.domain.hi - Index3{1, 1, 1};
  return {along({1, 0, 0}, i.x == first.x, i.x == last.x, spacing[0]),
          along({0, 1, 0}, i.y == first.y, i.y == last.y, spacing[1]),
          along({0, 0, 1}, i.z == first.z, i.z == last.z, spacing[2])};
}

}  // namespace weir
