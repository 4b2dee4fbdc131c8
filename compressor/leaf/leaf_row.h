// The survey pass keeps one fixed-size row of each 8^3 leaf, spilled to disk. The rows decide everything up to the
// encode pass.
#pragma once

#include <array>
#include <cstdint>

#include "format/leaf/block_summary.h"

namespace weir {

struct LeafRow : BlockSummary {
  /// Estimated squared error at 1, 2 and 4 bits per voxel, relative to `sse`; 1 if not estimated.
  std::array<float, 3> quantised{1, 1, 1};
  /// Bits per voxel (1, 2, 4, 8 or 16) that hold the finite values without loss; 0 if more are needed or if not sought.
  std::uint8_t exact_bits = 0;
  /// 1 if a voxel is stored as NaN or infinite and is not missing.
  std::uint8_t non_finite = 0;
  /// If all voxels are finite: the number of values equal to `min` or `max`; 0 if exact_bits is 1 to 8, or if not
  /// counted. If not all voxels are finite: largest_code() if exact_bits is not 0, otherwise the same number.
  std::uint16_t at_ends = 0;

  /// Returns the code of `max` on the lattice of the finite values (LeafLattice); 0 if all finite values are the same.
  /// Call it only if exact_bits is not 0 and some voxels are not finite.
  unsigned largest_code() const { return uniform() ? 0U : at_ends; }
  /// Returns whether any voxel has a value, finite or not.
  bool valued() const { return finite > 0 || non_finite != 0; }
  /// Returns the sum over the finite values of (value - fill)^2, exact up to double rounding.
  double sse_about(float fill) const {
    const double shift = static_cast<double>(mean) - static_cast<double>(fill);
    const double about =
        sse + 2.0 * shift * static_cast<double>(residual) + static_cast<double>(finite) * shift * shift;
    return about > 0 ? about : 0;
  }
  /// Returns the number of zeros that are lost if `fill` replaces the values.
  std::uint32_t zeros_lost_to(float fill) const { return fill == 0 ? 0U : zeros; }
  /// Returns the largest |value - fill| over the finite values.
  double max_abs_about(float fill) const {
    if (finite == 0) return 0;
    const double below = static_cast<double>(fill) - static_cast<double>(min);
    const double above = static_cast<double>(max) - static_cast<double>(fill);
    return below > above ? below : above;
  }
};
static_assert(sizeof(LeafRow) == 64, "rows are spilled as they are");

}  // namespace weir
