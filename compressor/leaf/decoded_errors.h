// The errors of a file's voxels, or of some of them, between the source's values and the decoded values.
#pragma once

#include <algorithm>
#include <cstdint>

#include "format/leaf/leaf_record.h"

namespace weir {

/// Errors over voxels of the domain. The default is for no voxel: nothing is lost.
struct DecodedErrors {
  double squared = 0;  ///< sum of squared errors over the finite voxels, in squared units of the data
  double max_abs = 0;  ///< the largest error, in units of the data
  Kept kept = Kept::all;
  std::uint64_t zeros_lost = 0;  ///< zeros that decode to another value

  /// Adds the errors of other voxels except `squared`. The caller sums that, and so decides its order and rounding.
  void add_but_squares(const DecodedErrors& other) {
    max_abs = std::max(max_abs, other.max_abs);
    kept = std::min(kept, other.kept);
    zeros_lost += other.zeros_lost;
  }
};

}  // namespace weir
