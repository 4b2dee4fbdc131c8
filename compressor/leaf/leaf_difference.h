// The difference between the decoded values of one leaf and the source's values.
#pragma once

#include <cstdint>

#include "format/base/index.h"
#include "format/leaf/bounds.h"
#include "format/leaf/leaf_codec.h"

namespace weir {

struct LeafDifference {
  double squared_error = 0;               ///< sum over the voxels that are finite on both sides
  double max_abs = 0;                     ///< largest error of the voxels that are finite on both sides
  std::uint32_t nonfinite = 0;            ///< source voxels that are not finite
  std::uint32_t nonfinite_decoded = 0;    ///< finite source voxels that decode to a non-finite value
  std::uint32_t different = 0;            ///< finite source voxels that decode to other bits
  std::uint32_t nonfinite_different = 0;  ///< non-finite source voxels that decode to other bits
  std::uint32_t zeros_lost = 0;           ///< source voxels equal to 0 that decode to another value
  MinMax range{};                         ///< range of the finite source voxels; min > max if there is none
};

/// Returns the difference of one leaf. Sums run in 16 lanes over the 512 voxels in leaf order, and lanes are added
/// pairwise, so that the result has the same bits on every instruction set.
LeafDifference difference_of(const LeafValues& source, const LeafValues& decoded);

/// Returns `values` at the voxels of `inside` in the leaf at `node`, and `outside` at all other voxels. Compared with
/// `outside`, the other voxels then make no difference.
LeafValues inside_only(const LeafValues& values, const LeafValues& outside, const Box& node, const Box& inside);

/// Returns |source - decoded| in double if both are finite, otherwise 0. LeafDifference::max_abs is the largest result.
double abs_difference(float source, float decoded);

}  // namespace weir
