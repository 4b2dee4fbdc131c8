// The quantiser of transformed blocks: which magnitude a coefficient becomes, and what that decodes to. For host and
// device.
#pragma once

#include <cstdint>

#include "format/base/host_device.h"

namespace weir {

/// Coefficients below that many steps become 0.
inline constexpr float kDeadZone = 0.6F;
/// And the others the whole part of their size in steps and this, at least 1.
inline constexpr float kRounding = 0.42F;
/// No coefficient of a row whose largest one is below that many steps counts.
inline constexpr float kRowDeadZone = 0.999F;

/// Where decoded coefficients lie in their steps: below_one and below_more of the constants.
inline constexpr float kBelowOne = -0.005F;
inline constexpr float kBelowMore = -0.045F;

/// Values of that size are not transformed, nor blocks of a smaller range.
inline constexpr float kLargestTransformed = 1e30F;
inline constexpr float kLeastTransformed = 1e-30F;
/// Coefficients of more steps than that are not coded.
inline constexpr double kMostMagnitude = 1e6;
/// Bits of what is not coded: more than of any stream.
inline constexpr std::uint32_t kNotCodedBits = 1U << 20U;

/// Rows whose largest coefficient is below that are zero at a step of that size.
WEIR_HOST_DEVICE inline float least_of_row(float step) { return kDeadZone * step * kRowDeadZone; }

/// Of a coefficient of `scaled` >= 0 steps.
WEIR_HOST_DEVICE inline std::int32_t magnitude_of(float scaled) {
  std::int32_t m = static_cast<std::int32_t>(scaled + kRounding);
  m = m < 1 ? 1 : m;
  return scaled < kDeadZone ? 0 : m;
}

/// What that loses, in steps.
WEIR_HOST_DEVICE inline float quantiser_error(float scaled, std::int32_t magnitude) {
  const float below = magnitude == 1 ? kBelowOne : kBelowMore;
  const float decoded = static_cast<float>(magnitude) - below;
  return scaled - (magnitude == 0 ? 0.0F : decoded);
}

}  // namespace weir
