// Converts the direction vectors of an array's axes in medical headers to the spacing and origin of a NanoVDB grid.
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
  /// A description of how the axes lie in the file's world, if weir does not keep this. Empty if they are the world's
  /// axes.
  std::string orientation;
};

/// Returns the placement of an array. `steps[a]` is the world step from voxel to voxel along axis a (x, y, z; at most
/// three, an axis without a step gets spacing 1). `zero` is the world position of index (0, 0, 0), `first` the index
/// of the first voxel. Voxels keep the file's order. spacing[a] is the length of step a. The origin is `zero`; if
/// each axis runs along a world axis, its components are in the order of the array's axes. Along an axis that runs
/// against its world axis, the origin is such that the first voxel lies where the file says (`zero` if `first` is 0).
/// `orientation` describes what is lost: flips and rotations.
AxisPlacement place_axes(std::span<const Vector3> steps, const Vector3& zero, const Index3& first = {});

/// Returns "x,y,z", as spacings and origins are shown and given.
std::string vector_text(const Vector3& v);

}  // namespace weir
