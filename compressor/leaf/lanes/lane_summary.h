// Range, mean, deviations and counts of eight leaves at once that repeat their values.
#pragma once

#include "compressor/leaf/lanes/lane_ranges.h"
#include "compressor/leaf/lanes/lane_shape.h"
#include "format/base/doubles8.h"

namespace weir {

/// Of each lane, as a LeafRow has them.
struct LaneSummary {
  LaneRanges ranges;
  Doubles8 sse;
  Ints8 zeros;
  Ints8 at_ends;  ///< values that equal the least or the largest
};

/// `values`: one of each group, finite ones, x fastest.
void summarize_lanes(const Floats8* values, const LaneShape& shape, LaneSummary& summary);

}  // namespace weir
