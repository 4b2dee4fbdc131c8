// Linear interpolation between the centres of coarse cells.
#pragma once

#include <span>

#include "format/base/index.h"

namespace weir {

/// Values of cells, x fastest.
struct CellValues {
  Box box;
  std::span<const float> values;
};

/// Returns the coarse cells that linear values of the cells in `fine` need: the coarse cells that `fine` overlaps,
/// and one more at each side along refined axes. `extent` is the extent of the coarse domain, which begins at 0.
Box linear_support(const Box& fine, const Index3& by, const Index3& extent);

/// Fills `part` of the box `fine` (`values`, x fastest) with trilinear values between the centres of `coarse` cells.
/// A coarse cell has `by` fine cells along each axis. Beyond the outermost centres of `coarse`, which should be at
/// the domain's edge, the edge's value is used. Computes in double. If not all contributing neighbours are finite, a
/// cell gets the value of the coarse cell that it lies in.
void upsample_linear(const CellValues& coarse, const Index3& by, const Box& part, const Box& fine,
                     std::span<float> values);

}  // namespace weir
