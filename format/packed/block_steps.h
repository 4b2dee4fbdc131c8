// The steps of the quantiser, and the code of a block's mean (FORMAT.md, "Steps"). For host and device.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "format/base/host_device.h"
#include "format/packed/block_constants.h"

namespace weir {

inline constexpr std::int32_t kLeastStep = -250;
inline constexpr std::int32_t kMostStep = 250;
/// The result of mean_bits() if the range is too wide for the step.
inline constexpr unsigned kNoMeanBits = 0xFF;

/// Returns 2^(-step / 2), for steps of -250 to 250; odd steps are rounded once.
WEIR_HOST_DEVICE inline float step_size(std::int32_t step) {
  const std::int32_t half = step >> 1;  // floor
  const auto exponent = static_cast<std::uint32_t>(127 - half) << 23U;
  float power;
  __builtin_memcpy(&power, &exponent, sizeof power);
  return (step & 1) != 0 ? 0.7071067811865476F * power : power;
}

/// Returns the coarsest step with a size of at most `size` > 0, or the finest step.
WEIR_HOST_DEVICE inline std::int32_t coarsest_step_within(double size) {
  std::uint64_t bits;
  __builtin_memcpy(&bits, &size, sizeof bits);
  const auto exponent = static_cast<std::int32_t>(bits >> 52U & 0x7FFU) - 1023;
  std::int32_t step = -2 * (exponent + 1);
  step = step < kLeastStep ? kLeastStep : step > kMostStep ? kMostStep : step;
  while (step<kMostStep&& static_cast<double>(step_size(step))> size) ++step;
  return step;
}

/// Number of rungs of a block's ladder, from coarse to fine; the first kLadderMeanRungs have no coefficient.
inline constexpr std::int32_t kLadderRungs = 22;
inline constexpr std::int32_t kLadderMeanRungs = 2;

/// Returns the step number of a rung, for a ladder with the first step `first`. Rungs go by whole octaves until the
/// first coefficient counts, then by half octaves, by whole ones again, and at last, for nearly lossless steps, by two
/// octaves.
WEIR_HOST_DEVICE constexpr std::int32_t rung_step(std::int32_t first, std::int32_t rung) {
  const std::int32_t r = rung;
  return first + (r <= 2 ? 2 * r : r <= 10 ? r + 2 : r <= 16 ? 2 * r - 8 : 4 * r - 40);
}

/// rung_step() less `first`, for each rung.
inline constexpr std::array<std::int8_t, kLadderRungs> kRungOffsets = [] {
  std::array<std::int8_t, kLadderRungs> offsets{};
  for (std::int32_t rung = 0; rung < kLadderRungs; ++rung) {
    offsets[static_cast<std::size_t>(rung)] = static_cast<std::int8_t>(rung_step(0, rung));
  }
  return offsets;
}();

/// Returns the step number of the first rung for a block with the given largest coefficient: four steps before that
/// coefficient counts.
WEIR_HOST_DEVICE inline std::int32_t first_rung_step(double largest) {
  constexpr std::int32_t kMeanSteps = 4;
  constexpr double kCounts = 0.6;  // steps
  return coarsest_step_within(largest / kCounts) - kMeanSteps;
}

/// Returns the rung at which a search around the step `wanted` begins.
WEIR_HOST_DEVICE inline std::int32_t rung_about(std::int32_t first, std::int32_t wanted) {
  // The first rung with a step as fine as `wanted`: the inverse of rung_step().
  const std::int32_t finer = wanted - first;
  const std::int32_t rung = finer <= 4    ? kLadderMeanRungs
                            : finer <= 12 ? finer - 2
                            : finer <= 24 ? (finer + 9) / 2
                                          : (finer + 43) / 4;
  return rung < kLadderRungs ? rung : kLadderRungs - 1;
}

/// Returns the distance of two means with consecutive codes.
WEIR_HOST_DEVICE inline float mean_quantum(std::int32_t step) { return step_size(step) * 0.04419417382415922F; }

/// Returns the bits of a mean's code; kNoMeanBits if it would have more than 24.
WEIR_HOST_DEVICE inline unsigned mean_bits(const MeanRange& range, std::int32_t step) {
  const float width = range.high - range.low;
  const float codes = width / mean_quantum(step);
  if (!(codes < 16777214.0F)) return kNoMeanBits;
  return 32U - static_cast<unsigned>(__builtin_clz(static_cast<std::uint32_t>(codes) + 1));
}

/// Returns the mean of a code.
WEIR_HOST_DEVICE inline float decode_mean(const MeanRange& range, std::int32_t step, std::uint32_t code) {
  const float offset = static_cast<float>(code) * mean_quantum(step);
  return range.low + offset;
}

/// Returns the code at a step that is nearest to a mean in the range.
WEIR_HOST_DEVICE inline std::uint32_t mean_code(const MeanRange& range, std::int32_t step, float mean) {
  const float width = range.high - range.low;
  const float quantum = mean_quantum(step);
  const double last = static_cast<double>(static_cast<std::uint32_t>(width / quantum) + 1);
  const double code = rint((static_cast<double>(mean) - static_cast<double>(range.low)) / static_cast<double>(quantum));
  return static_cast<std::uint32_t>(code < 0 ? 0.0 : code > last ? last : code);
}

}  // namespace weir
