#include "ingest/values/half_values.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "ingest/values/convert_values.h"

namespace weir {

std::uint16_t half_bits(double value) {
  constexpr int kFractionBits = 10;
  constexpr int kLeastExponent = -14;
  const auto sign = static_cast<std::uint16_t>(std::signbit(value) ? 0x8000 : 0);
  if (std::isnan(value)) return 0x7E00;
  if (std::isinf(value)) return sign | 0x7C00;
  const double size = std::fabs(value);
  const int exponent = size == 0 ? kLeastExponent : std::max(std::ilogb(size), kLeastExponent);
  // The leading bit of a normal number adds the 1 that is missing in the exponent.
  const int fraction = static_cast<int>(std::nearbyint(std::ldexp(size, kFractionBits - exponent)));
  return static_cast<std::uint16_t>(sign | (((exponent - kLeastExponent) << kFractionBits) + fraction));
}

std::uint16_t bfloat16_bits(double value) {
  if (std::isnan(value)) return 0x7FC0;
  const auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(value));
  return static_cast<std::uint16_t>((bits + 0x7FFFU + (bits >> 16U & 1U)) >> 16U);
}

ValueMapping with_stored_missing(const ValueMapping& mapping, ScalarType type) {
  std::vector<StoredValue> stored;
  for (const StoredValue& value : mapping.missing) {
    if (!holds(type, value)) continue;
    const double number = as_double(value);
    const std::array<std::uint16_t, 1> bits{type == ScalarType::float16 ? half_bits(number) : bfloat16_bits(number)};
    std::array<float, 1> widened{};
    convert_values(std::as_bytes(std::span(bits)), type, kNativeIsBig, widened);
    stored.emplace_back(static_cast<double>(widened[0]));
  }
  ValueMapping rounded = mapping;
  rounded.missing = std::move(stored);
  return rounded;
}

}  // namespace weir
