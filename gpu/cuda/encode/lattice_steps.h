// Whether a block's values may lie on a lattice of their own (compressor/leaf/leaf_lattice.h). The answer is never
// "no" for values that do, and hardly ever "yes" for others. For host and device.
#pragma once

#include <cstdint>

#include "format/base/host_device.h"
#include "gpu/cuda/encode/transform_steps.h"

namespace weir::encode_detail {

// The largest code on a lattice of a block's own.
inline constexpr std::uint64_t kLargestLatticeCode = 65535;

// Returns 2^exponent as a normal float.
WEIR_HOST_DEVICE inline float power_of_two(std::int32_t exponent) {
  const auto bits = static_cast<std::uint32_t>(127 + exponent) << 23U;
  float power;
  __builtin_memcpy(&power, &bits, sizeof power);
  return power;
}

// Returns the inverse of the unit in which find_lattice() counts values of magnitude `magnitude`.
WEIR_HOST_DEVICE inline float lattice_scale(float magnitude) {
  std::uint32_t bits;
  __builtin_memcpy(&bits, &magnitude, sizeof bits);
  const std::int32_t exponent = static_cast<std::int32_t>(bits >> 23U & 0xFFU) - 127;
  return power_of_two(23 - exponent);
}

WEIR_HOST_DEVICE inline std::uint32_t common_divisor(std::uint32_t a, std::uint32_t b) {
  while (b != 0) {
    const std::uint32_t rest = a % b;
    a = b;
    b = rest;
  }
  return a;
}

// Returns whether the values may lie on a lattice. `stage` holds the values unchanged.
template <class Warp>
WEIR_HOST_DEVICE bool may_lie_on_lattice(const Warp& warp, const ValueRange8& range, const float* stage) {
  const float below = range.low < 0 ? -range.low : range.low;
  const float above = range.high < 0 ? -range.high : range.high;
  const float magnitude = below > above ? below : above;
  if (!(magnitude >= 0x1p-100F && magnitude <= 0x1p100F) || !(range.low < range.high)) return false;
  const float scale = lattice_scale(magnitude);
  typename Warp::template Own<std::uint32_t> found;
  const auto either = [](std::uint32_t a, std::uint32_t b) { return a | b; };
  warp.each([&](unsigned lane) {
    std::uint32_t bad = 0;
    WEIR_UNROLL
    for (unsigned k = 0; k < 16; ++k) {
      const float v = stage[stage_of(lane + kLanes * k)];
      std::uint32_t bits;
      __builtin_memcpy(&bits, &v, sizeof bits);
      if ((bits & 0x7F800000U) == 0x7F800000U) {
        bad |= 1U;
        continue;
      }
      const float scaled = v * scale;
      const auto whole = static_cast<std::int32_t>(scaled);
      bad |= static_cast<float>(whole) != scaled ? 1U : 0U;
      bad |= whole == 0 && bits != 0 ? 1U : 0U;
    }
    found(lane) = bad;
  });
  if (warp.of_all(found, either) != 0) return false;
  const auto lowest = static_cast<std::int32_t>(range.low * scale);
  const auto span = static_cast<std::uint32_t>(static_cast<std::int32_t>(range.high * scale) - lowest);
  // A lattice's step divides the range and every value's distance from the lowest, so also their common divisor. A few
  // values are enough to rule out a lattice for most blocks.
  warp.each([&](unsigned lane) {
    const float v = stage[stage_of(17 * lane % 512)];
    const auto step = common_divisor(span, static_cast<std::uint32_t>(static_cast<std::int32_t>(v * scale) - lowest));
    found(lane) = kLargestLatticeCode * step < span ? 1U : 0U;
  });
  return warp.of_all(found, either) == 0;
}

}  // namespace weir::encode_detail
