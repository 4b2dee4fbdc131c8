// The quantiser of transformed blocks: the magnitude of a coefficient, and the value that a magnitude decodes to. For
// host and device.
#pragma once

#include <cstdint>

#include "format/base/host_device.h"

namespace weir {

/// Coefficients below this many steps become 0.
inline constexpr float kDeadZone = 0.6F;
/// Other coefficients become the whole part of their size in steps plus this, but at least 1.
inline constexpr float kRounding = 0.42F;
/// A row is zero if its largest coefficient is below this share of the dead zone; its coefficients are then not checked
/// one by one. With a share of 1, rounding could make the result wrong.
inline constexpr float kRowDeadZone = 0.999F;

/// The place of decoded coefficients in their steps: below_one and below_more of the constants.
inline constexpr float kBelowOne = -0.005F;
inline constexpr float kBelowMore = -0.045F;

/// A block is not transformed if a value's magnitude is at least this, or if the range of all values is less than
/// kLeastTransformed.
inline constexpr float kLargestTransformed = 1e30F;
inline constexpr float kLeastTransformed = 1e-30F;
/// Coefficients of more steps than this are not coded.
inline constexpr double kMostMagnitude = 1e6;
/// The cost in bits of a block that is not coded: more than any stream has.
inline constexpr std::uint32_t kNotCodedBits = 1U << 20U;

/// Rows with a largest coefficient below this are zero at a step of size `step`.
WEIR_HOST_DEVICE inline float least_of_row(float step) { return kDeadZone * step * kRowDeadZone; }

/// Returns the magnitude of a coefficient of `scaled` >= 0 steps.
WEIR_HOST_DEVICE inline std::int32_t magnitude_of(float scaled) {
  std::int32_t m = static_cast<std::int32_t>(scaled + kRounding);
  m = m < 1 ? 1 : m;
  return scaled < kDeadZone ? 0 : m;
}

/// Returns how much larger the coefficient is than the decoded value of `magnitude`, in steps.
WEIR_HOST_DEVICE inline float quantiser_error(float scaled, std::int32_t magnitude) {
  const float below = magnitude == 1 ? kBelowOne : kBelowMore;
  const float decoded = static_cast<float>(magnitude) - below;
  return scaled - (magnitude == 0 ? 0.0F : decoded);
}

}  // namespace weir
