// From the direction vectors that medical headers give an array's axes to the
// spacing and origin that a NanoVDB grid takes here.
#pragma once

#include <array>
#include <span>
#include <string>

#include "format/base/index.h"

namespace weir {

using Vector3 = std::array<double, 3>;

struct AxisPlacement {
  Vector3 spacing{1.0, 1.0, 1.0};
  Vector3 origin{0.0, 0.0, 0.0};
  /// How the axes lie in the file's world where weir does not keep it, for people; empty where they are its axes.
  std::string orientation;
};

/// `steps[a]` is the world step from voxel to voxel along axis a (x, y, z; at most three, an axis without one
/// gets spacing 1), `zero` the world position of index (0, 0, 0), and `first` the index of the first voxel. Voxels keep
/// the file's order: spacing[a] is the length of step a, and the origin is `zero`, its components in the order of the
/// axes where each axis runs along one of the world's. Along one that runs against it the origin is such that the first
/// voxel lies where the file says; where `first` is 0, that is `zero`. What all this loses, flips and rotations, is in
/// `orientation`.
AxisPlacement place_axes(std::span<const Vector3> steps, const Vector3& zero, const Index3& first = {});

/// "x,y,z", as spacings and origins are shown and given.
std::string vector_text(const Vector3& v);

}  // namespace weir
