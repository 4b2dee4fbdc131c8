// The ranges of the values of eight leaves, one leaf per lane.
#pragma once

#include "format/base/simd.h"

namespace weir {

/// The members have the meaning that they have in a LeafRow.
struct LaneRanges {
  Floats8 min;
  Floats8 max;
  Floats8 mean;
  Floats8 residual;
};

/// A range of at least this width, with values of at most this magnitude, has levels of any number of bits, and nothing
/// that a fit computes leaves the range of its type.
inline constexpr float kLeastLaneWidth = 0x1p-60F;
inline constexpr float kMostLaneMagnitude = 0x1p+60F;

}  // namespace weir
