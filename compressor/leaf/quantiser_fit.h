// What the fits of a quantiser have in common, of one leaf (leaf_quantiser.h) and of several at once
// (lanes/lane_estimates.h): where they begin, and where they end.
#pragma once

#include <array>

namespace weir {

/// Quanta below this have no reciprocal.
inline constexpr float kLeastQuantum = 0x1p-120F;
/// Squared errors below this part of the squared deviations are measured, for any number of bits.
inline constexpr double kCancelled = 1e-4;
/// Levels are at most this far apart, so that code * quantum stays a number: values may be twice as far.
inline constexpr double kWidest = 0x1.fffffp+127;

/// How the error at a width is estimated.
struct EstimateStart {
  double share;  ///< of the range, which the levels divide at first
  int rounds;
  double gain;  ///< what is left of the error by the rounds left out
};

/// At 1, 2 and 4 bits. What the rounds left out gain on average: 0.1 dB at 1 bit, 0.4 dB at 2, 0.2 dB at 4, so that the
/// estimates of a volume's leaves are neither too low nor too high.
inline constexpr std::array<EstimateStart, 3> kEstimateStarts{{{0.7, 2, 0.97}, {1, 3, 0.92}, {1, 1, 0.955}}};

}  // namespace weir
