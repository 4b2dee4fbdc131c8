// What is lost of voxels, all of a file or some, between a source's values and those that a reader decodes.
#pragma once

#include <algorithm>
#include <cstdint>

#include "format/leaf/leaf_record.h"

namespace weir {

/// Over voxels of the domain; of none: nothing is lost.
struct DecodedErrors {
  double squared = 0;  ///< sum over the finite ones, in squared units of the data
  double max_abs = 0;  ///< the largest, in units of the data
  Kept kept = Kept::all;
  std::uint64_t zeros_lost = 0;  ///< zeros that read another value

  /// Adds all of other voxels' but the squares, whose sum's order and rounding are the caller's affair.
  void add_but_squares(const DecodedErrors& other) {
    max_abs = std::max(max_abs, other.max_abs);
    kept = std::min(kept, other.kept);
    zeros_lost += other.zeros_lost;
  }
};

}  // namespace weir
