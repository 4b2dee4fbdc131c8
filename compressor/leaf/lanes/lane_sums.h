// Sums over the 512 values of leaves that repeat them, eight leaves at once.
#pragma once

#include "compressor/leaf/lanes/lane_shape.h"
#include "format/base/doubles8.h"

namespace weir {

/// Sets `total` to what the sums of twin_sums.h and leaf_summary.h add up over 512 values, in the same order, for each
/// lane: `terms` has one of each group, x fastest. Of the lanes of those sums, which run along a row, groups make
/// several the same: each is added up once.
void sum_groups(const Floats8* terms, const LaneShape& shape, Floats8& total);
void sum_groups(const Doubles8* terms, const LaneShape& shape, Doubles8& total);

}  // namespace weir
