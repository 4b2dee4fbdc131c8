// The quantiser of transformed blocks: which magnitude a coefficient becomes, and what that decodes to. For host and
// device.
#pragma once

#include <cstdint>

#include "format/base/host_device.h"

namespace weir {

/// Coefficients below that many steps become 0.
inline constexpr float kDeadZone = 0.6F;
/// The others become the whole part of this plus their size in steps, but at least 1.
inline constexpr float kRounding = 0.42F;
/// A row whose largest coefficient is below this share of the dead zone is taken as zero without a look at each one; at
/// a share of 1, rounding could make that wrong.
inline constexpr float kRowDeadZone = 0.999F;

/// Where decoded coefficients lie in their steps: below_one and below_more of the constants.
inline constexpr float kBelowOne = -0.005F;
inline constexpr float kBelowMore = -0.045F;

/// A block is not transformed where a value has this size or more, or where all values lie in a range of less than
/// kLeastTransformed.
inline constexpr float kLargestTransformed = 1e30F;
inline constexpr float kLeastTransformed = 1e-30F;
/// Coefficients of more steps than that are not coded.
inline constexpr double kMostMagnitude = 1e6;
/// Bits of what is not coded: more than of any stream.
inline constexpr std::uint32_t kNotCodedBits = 1U << 20U;

/// Rows whose largest coefficient is below that are zero at a step of that size.
WEIR_HOST_DEVICE inline float least_of_row(float step) { return kDeadZone * step * kRowDeadZone; }

/// The magnitude that a coefficient of `scaled` >= 0 steps becomes.
WEIR_HOST_DEVICE inline std::int32_t magnitude_of(float scaled) {
  std::int32_t m = static_cast<std::int32_t>(scaled + kRounding);
  m = m < 1 ? 1 : m;
  return scaled < kDeadZone ? 0 : m;
}

/// How much larger the coefficient is than what that magnitude decodes to, in steps.
WEIR_HOST_DEVICE inline float quantiser_error(float scaled, std::int32_t magnitude) {
  const float below = magnitude == 1 ? kBelowOne : kBelowMore;
  const float decoded = static_cast<float>(magnitude) - below;
  return scaled - (magnitude == 0 ? 0.0F : decoded);
}

}  // namespace weir
