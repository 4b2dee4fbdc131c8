// The positions in a volume at which windows of one size begin.
#pragma once

#include <algorithm>
#include <cstdint>

#include "format/base/index.h"

namespace weir {

/// The windows along an axis. They begin at every `stride`-th voxel from the lowest one on; an additional last window
/// ends with the axis. All windows lie wholly in the axis, and together they cover it.
struct WindowBegins {
  std::int64_t extent = 1;  ///< voxels along the axis
  std::int64_t size = 1;    ///< voxels of a window, from 1 to `extent`
  std::int64_t stride = 1;  ///< from 1 to `size`

  std::int64_t last() const { return extent - size; }
  std::int64_t count() const { return ceil_div(last(), stride) + 1; }
  std::int64_t at(std::int64_t window) const { return std::min(window * stride, last()); }
  /// Returns the first window that begins at voxel `from` >= 0 or above; count() if there is none.
  std::int64_t first_from(std::int64_t from) const { return from > last() ? count() : ceil_div(from, stride); }
};

/// The windows along the three axes of a volume. Voxel coordinates are relative to the volume's lowest voxel.
struct VolumeWindows {
  WindowBegins x;
  WindowBegins y;
  WindowBegins z;

  /// Returns the window numbers, as a box, of the windows that begin in `part`, a box of the volume.
  Box in(const Box& part) const {
    return {{x.first_from(part.lo.x), y.first_from(part.lo.y), z.first_from(part.lo.z)},
            {x.first_from(part.hi.x), y.first_from(part.hi.y), z.first_from(part.hi.z)}};
  }
  /// Returns the lowest voxel of a window.
  Index3 at(const Index3& window) const { return {x.at(window.x), y.at(window.y), z.at(window.z)}; }
};

}  // namespace weir
