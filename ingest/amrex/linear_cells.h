// Linear values between the centres of coarse cells.
#pragma once

#include <span>

#include "format/base/index.h"

namespace weir {

/// Values of cells, x fastest.
struct CellValues {
  Box box;
  std::span<const float> values;
};

/// The coarse cells that linear values of the cells in `fine` need: those with cells there, and one more at each side
/// along axes that are refined. `extent`: of the coarse domain, which begins at 0.
Box linear_support(const Box& fine, const Index3& by, const Index3& extent);

/// Fills `part` of the box `fine`, `values` x fastest, with trilinear values between the centres of `coarse` cells, of
/// which each has `by` cells along the axes. Beyond the centres at the edge of `coarse` the edge's value holds, which
/// is meant for the edge of the domain. Computed in double. A cell whose neighbours that count are not all finite gets
/// the value of the coarse cell it lies in.
void upsample_linear(const CellValues& coarse, const Index3& by, const Box& part, const Box& fine,
                     std::span<float> values);

}  // namespace weir
