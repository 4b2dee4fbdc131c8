// What the survey pass keeps of each 8^3 leaf: one fixed-size row, spilled to
// disk, from which everything up to the encode pass is decided.
#pragma once

#include <array>
#include <cstdint>

#include "format/leaf/block_summary.h"

namespace weir {

struct LeafRow : BlockSummary {
  /// Squared error at 1, 2 and 4 bits a voxel, estimated, in parts of `sse`; 1 where it was not looked at.
  std::array<float, 3> quantised{1, 1, 1};
  /// Bits a voxel, 1, 2, 4, 8 or 16, that hold the finite values without loss; 0: more, or not looked at.
  std::uint8_t exact_bits = 0;
  /// 1 where a voxel is NaN or infinite as it is stored, and not missing.
  std::uint8_t non_finite = 0;
  /// Of a row whose voxels all have values: those equal to `min` or `max`, 0 where exact_bits is 8 or less, or not
  /// looked at. Of another row: largest_code() where exact_bits is not 0, else as of the former.
  std::uint16_t at_ends = 0;

  /// The code of `max` on the lattice of the finite values (LeafLattice), where exact_bits is not 0 and some voxels
  /// have no value; 0 where all others have the same one.
  unsigned largest_code() const { return uniform() ? 0U : at_ends; }
  /// Whether any voxel has a value, finite or not.
  bool valued() const { return finite > 0 || non_finite != 0; }
  /// Sum over the finite values of (value - fill)^2; exact up to double rounding.
  double sse_about(float fill) const {
    const double shift = static_cast<double>(mean) - static_cast<double>(fill);
    const double about =
        sse + 2.0 * shift * static_cast<double>(residual) + static_cast<double>(finite) * shift * shift;
    return about > 0 ? about : 0;
  }
  /// Zeros that a reader of `fill` in place of the values does not see.
  std::uint32_t zeros_lost_to(float fill) const { return fill == 0 ? 0U : zeros; }
  /// Largest |value - fill| over the finite values.
  double max_abs_about(float fill) const {
    if (finite == 0) return 0;
    const double below = static_cast<double>(fill) - static_cast<double>(min);
    const double above = static_cast<double>(max) - static_cast<double>(fill);
    return below > above ? below : above;
  }
};
static_assert(sizeof(LeafRow) == 64, "rows are spilled as they are");

}  // namespace weir
