// Finds range, mean, deviations and counts of eight leaves at once that repeat their values.
#pragma once

#include "compressor/leaf/lanes/lane_ranges.h"
#include "compressor/leaf/lanes/lane_shape.h"
#include "format/base/doubles8.h"

namespace weir {

/// The figures of each lane, with the meaning that they have in a LeafRow.
struct LaneSummary {
  LaneRanges ranges;
  Doubles8 sse;
  Ints8 zeros;
  Ints8 at_ends;  ///< number of values that equal the least or the largest
};

/// Sets the summary of each lane. `values` has one finite value of each group, x fastest.
void summarize_lanes(const Floats8* values, const LaneShape& shape, LaneSummary& summary);

}  // namespace weir
