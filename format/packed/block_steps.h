// Steps of the quantiser, and the code of a block's mean (FORMAT.md, "Steps"). For host and device.
#pragma once

#include <cstdint>

#include "format/base/host_device.h"
#include "format/packed/block_constants.h"

namespace weir {

inline constexpr std::int32_t kLeastStep = -250;
inline constexpr std::int32_t kMostStep = 250;
/// What mean_bits gives where the range is too wide for the step.
inline constexpr unsigned kNoMeanBits = 0xFF;

/// 2^(-step / 2), for steps of -250 to 250; odd ones rounded once.
WEIR_HOST_DEVICE inline float step_size(std::int32_t step) {
  const std::int32_t half = step >> 1;  // floor
  const auto exponent = static_cast<std::uint32_t>(127 - half) << 23U;
  float power;
  __builtin_memcpy(&power, &exponent, sizeof power);
  return (step & 1) != 0 ? 0.7071067811865476F * power : power;
}

/// Distance of two means whose codes follow each other.
WEIR_HOST_DEVICE inline float mean_quantum(std::int32_t step) { return step_size(step) * 0.04419417382415922F; }

/// Bits of a mean's code; kNoMeanBits where it would have more than 24.
WEIR_HOST_DEVICE inline unsigned mean_bits(const MeanRange& range, std::int32_t step) {
  const float width = range.high - range.low;
  const float codes = width / mean_quantum(step);
  if (!(codes < 16777214.0F)) return kNoMeanBits;
  return 32U - static_cast<unsigned>(__builtin_clz(static_cast<std::uint32_t>(codes) + 1));
}

}  // namespace weir
