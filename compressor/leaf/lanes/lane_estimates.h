// Estimates the errors of quantised leaves (leaf_quantiser.h) for eight leaves at once that repeat their values.
#pragma once

#include <array>

#include "compressor/leaf/lanes/lane_ranges.h"
#include "compressor/leaf/lanes/lane_shape.h"
#include "format/base/doubles8.h"

namespace weir {

/// Sets the squared errors that estimated_errors finds at 1, 2 and 4 bits before it applies its gains, bit for bit;
/// infinite if it finds none. Lanes with a range outside the limits in lane_ranges.h get undefined results. `values`
/// has one value of each group, x fastest.
void estimate_lanes(const Floats8* values, const LaneShape& shape, const LaneRanges& ranges,
                    std::array<Doubles8, 3>& squared_errors);

}  // namespace weir
