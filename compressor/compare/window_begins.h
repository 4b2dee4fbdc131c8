// Where windows of one size begin in a volume.
#pragma once

#include <algorithm>
#include <cstdint>

#include "format/base/index.h"

namespace weir {

/// Along an axis: at every `stride`-th voxel from the lowest one on, and once more so that the last window ends with
/// the axis. Windows lie in the axis whole, and together they hold all of it.
struct WindowBegins {
  std::int64_t extent = 1;  ///< voxels along the axis
  std::int64_t size = 1;    ///< of a window, from 1 to `extent`
  std::int64_t stride = 1;  ///< from 1 to `size`

  std::int64_t last() const { return extent - size; }
  std::int64_t count() const { return ceil_div(last(), stride) + 1; }
  std::int64_t at(std::int64_t window) const { return std::min(window * stride, last()); }
  /// The first window that begins at voxel `from` >= 0 or above it; count() where there is none.
  std::int64_t first_from(std::int64_t from) const { return from > last() ? count() : ceil_div(from, stride); }
};

/// Along the three axes of a volume. All voxels are counted from its lowest one.
struct VolumeWindows {
  WindowBegins x;
  WindowBegins y;
  WindowBegins z;

  /// Numbers of the windows that begin in `part`, a box of the volume.
  Box in(const Box& part) const {
    return {{x.first_from(part.lo.x), y.first_from(part.lo.y), z.first_from(part.lo.z)},
            {x.first_from(part.hi.x), y.first_from(part.hi.y), z.first_from(part.hi.z)}};
  }
  /// Lowest voxel of one of them.
  Index3 at(const Index3& window) const { return {x.at(window.x), y.at(window.y), z.at(window.z)}; }
};

}  // namespace weir
