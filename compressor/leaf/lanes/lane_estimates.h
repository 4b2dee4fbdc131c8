// The estimated errors of quantised leaves (leaf_quantiser.h), of eight leaves at once that repeat their values.
#pragma once

#include <array>

#include "compressor/leaf/lanes/lane_ranges.h"
#include "compressor/leaf/lanes/lane_shape.h"
#include "format/base/doubles8.h"

namespace weir {

/// The squared errors that estimated_errors finds at 1, 2 and 4 bits, before its gains, to the bit; infinite where it
/// finds none. Of lanes whose range is as lane_ranges.h says; anything of others. `values`: one of each group, x
/// fastest.
void estimate_lanes(const Floats8* values, const LaneShape& shape, const LaneRanges& ranges,
                    std::array<Doubles8, 3>& squared_errors);

}  // namespace weir
