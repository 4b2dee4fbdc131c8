// Sums over the 512 values of leaves that repeat their values, eight leaves at once.
#pragma once

#include "compressor/leaf/lanes/lane_shape.h"
#include "format/base/doubles8.h"

namespace weir {

/// Sets each lane of `total` to the sum that twin_sums.h and leaf_summary.h compute over 512 values, in the same order
/// of additions. `terms` has one term of each group, x fastest. The lanes of these sums run along a row, so that groups
/// make several of them equal; each distinct lane is summed once.
void sum_groups(const Floats8* terms, const LaneShape& shape, Floats8& total);
void sum_groups(const Doubles8* terms, const LaneShape& shape, Doubles8& total);

}  // namespace weir
