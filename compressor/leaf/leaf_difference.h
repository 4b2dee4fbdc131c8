// How the decoded values of one leaf differ from the source's.
#pragma once

#include <cstdint>

#include "format/base/index.h"
#include "format/leaf/bounds.h"
#include "format/leaf/leaf_codec.h"

namespace weir {

struct LeafDifference {
  double squared_error = 0;               ///< summed over the voxels finite on both sides
  double max_abs = 0;                     ///< of those
  std::uint32_t nonfinite = 0;            ///< source voxels that are not finite
  std::uint32_t nonfinite_decoded = 0;    ///< decoded ones that are not, where the source is
  std::uint32_t different = 0;            ///< finite source voxels whose bits differ
  std::uint32_t nonfinite_different = 0;  ///< and not finite ones
  std::uint32_t zeros_lost = 0;           ///< source voxels equal to 0 whose decoded value is not
  MinMax range{};                         ///< of the finite source voxels; min > max where there is none
};

/// Sums run in 16 lanes over the 512 voxels in leaf order, lanes are added pairwise: the same bits on
/// every instruction set.
LeafDifference difference_of(const LeafValues& source, const LeafValues& decoded);

/// `values` at the voxels of `inside` in the leaf at `node`, `outside` at the others: these then make no difference
/// from what has `outside` there.
LeafValues inside_only(const LeafValues& values, const LeafValues& outside, const Box& node, const Box& inside);

/// |source - decoded| in double where both are finite, else 0: what max_abs is the largest of.
double abs_difference(float source, float decoded);

}  // namespace weir
