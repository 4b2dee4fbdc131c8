// A part of a volume with groups of equal voxels, for instance coarse cells on a finer grid.
#pragma once

#include <cstdint>

#include "format/base/index.h"

namespace weir {

/// A box of voxels in groups of `by` voxels along the axes, counted from its lowest corner. All voxels of a group
/// have one value.
struct RepeatedPart {
  Box box;  ///< index space; extents are multiples of `by`, corners lie on multiples of it
  Index3 by{1, 1, 1};

  bool repeats() const { return by != Index3{1, 1, 1}; }
  Index3 groups() const {
    const Index3 e = box.extent();
    return {e.x / by.x, e.y / by.y, e.z / by.z};
  }
  /// Returns the number of groups, which is the number of distinct values.
  std::int64_t values() const { return volume(groups()); }
};

}  // namespace weir
