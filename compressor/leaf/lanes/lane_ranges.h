// What the survey knows of the values of eight leaves, one a lane.
#pragma once

#include "format/base/simd.h"

namespace weir {

/// As in a LeafRow, but for its sum of squares.
struct LaneRanges {
  Floats8 min;
  Floats8 max;
  Floats8 mean;
  Floats8 residual;
};

/// Of this width and more, between values of no larger magnitude than that, a range has levels of any number of bits,
/// and nothing that a fit computes leaves the range of its type.
inline constexpr float kLeastLaneWidth = 0x1p-60F;
inline constexpr float kMostLaneMagnitude = 0x1p+60F;

}  // namespace weir
