// A part of a volume whose voxels repeat each other, as those of coarse cells on a finer grid do.
#pragma once

#include <cstdint>

#include "format/base/index.h"

namespace weir {

/// The voxels of a box in groups of `by` along the axes, from its lowest corner on, that have one value each.
struct RepeatedPart {
  Box box;  ///< index space; extents are multiples of `by`, corners lie on multiples of it
  Index3 by{1, 1, 1};

  bool repeats() const { return by != Index3{1, 1, 1}; }
  Index3 groups() const {
    const Index3 e = box.extent();
    return {e.x / by.x, e.y / by.y, e.z / by.z};
  }
  /// Of all groups.
  std::int64_t values() const { return volume(groups()); }
};

}  // namespace weir
