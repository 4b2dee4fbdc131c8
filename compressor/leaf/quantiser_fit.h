// Constants that both fits of quantisers share: the fit of one leaf (leaf_quantiser.h) and the fit of several leaves at
// once (lanes/lane_estimates.h).
#pragma once

#include <array>

namespace weir {

/// Smaller quanta have no reciprocal.
inline constexpr float kLeastQuantum = 0x1p-120F;
/// Squared errors below this share of the squared deviations are measured value by value, at any number of bits.
inline constexpr double kCancelled = 1e-4;
/// The first and the last level are at most this far apart, so that code * quantum stays a float. Values may be twice
/// as far apart.
inline constexpr double kWidest = 0x1.fffffp+127;

/// How the error at a number of bits is estimated.
struct EstimateStart {
  double share;  ///< share of the range that the first levels divide
  int rounds;
  double gain;  ///< factor by which the rounds that are left out would lower the error
};

/// The starts at 1, 2 and 4 bits. The rounds that are left out would gain 0.1 dB at 1 bit, 0.4 dB at 2 and 0.2 dB at 4
/// on average. The gains correct for this, so that the estimates of a volume's leaves are neither too low nor too high.
inline constexpr std::array<EstimateStart, 3> kEstimateStarts{{{0.7, 2, 0.97}, {1, 3, 0.92}, {1, 1, 0.955}}};

}  // namespace weir
