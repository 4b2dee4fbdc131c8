#include "ingest/synthetic/pack_values.h"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>

#include "format/base/error.h"
#include "format/base/text.h"

namespace weir {
namespace {

struct Limits {
  double lowest;
  double highest;
};

template <typename T>
constexpr Limits limits_of() {
  return {static_cast<double>(std::numeric_limits<T>::lowest()), static_cast<double>(std::numeric_limits<T>::max())};
}

Limits integer_limits(ScalarType type) {
  switch (type) {
    case ScalarType::uint8:
      return limits_of<std::uint8_t>();
    case ScalarType::int8:
      return limits_of<std::int8_t>();
    case ScalarType::uint16:
      return limits_of<std::uint16_t>();
    case ScalarType::int16:
      return limits_of<std::int16_t>();
    case ScalarType::uint32:
      return limits_of<std::uint32_t>();
    default:
      return limits_of<std::int32_t>();
  }
}

bool is_integer(ScalarType type) { return type != ScalarType::float32 && type != ScalarType::float64; }
bool has_arithmetic(ScalarType type) { return type != ScalarType::float16 && type != ScalarType::bfloat16; }

template <typename T>
void pack_as(std::span<const float> values, double scale, double shift, bool swap, std::byte* out) {
  for (const float value : values) {
    T result{};
    if constexpr (std::is_integral_v<T>) {
      constexpr Limits kLimits = limits_of<T>();
      const double scaled = static_cast<double>(value) * scale + shift;
      const double clamped = std::clamp(scaled, kLimits.lowest, kLimits.highest);
      result = static_cast<T>(static_cast<std::int64_t>(clamped + (clamped < 0.0 ? -0.5 : 0.5)));
    } else {
      result = static_cast<T>(value);
    }
    std::array<std::byte, sizeof(T)> bytes;
    std::memcpy(bytes.data(), &result, sizeof(T));
    if (swap) std::reverse(bytes.begin(), bytes.end());
    std::memcpy(out, bytes.data(), sizeof(T));
    out += sizeof(T);
  }
}

}  // namespace

ValuePacker::ValuePacker(const SyntheticKind& kind, ScalarType type, bool big_endian)
    : type_(type),
      big_endian_(big_endian),
      identity_(type == ScalarType::float32 && big_endian == (std::endian::native == std::endian::big)) {
  if (!has_arithmetic(type) || type == ScalarType::uint64 || type == ScalarType::int64) {
    throw Error(ErrorKind::usage, cat("synthetic volumes have no type ", scalar_name(type),
                                      "; use float32, float64 or an integer of up to 32 bits"));
  }
  if (!is_integer(type)) return;
  const Limits limits = integer_limits(type);
  const auto low = static_cast<double>(kind.min);
  const auto high = static_cast<double>(kind.max);
  switch (kind.scaling) {
    case IntegerScaling::none:
      throw Error(ErrorKind::usage,
                  compose("kind '", kind.name, "' has values that are not finite, which ", scalar_name(type),
                          " cannot hold; use ", option("type"), " float32 or float64"));
    case IntegerScaling::verbatim:
      if (low < limits.lowest || high > limits.highest) {
        throw Error(ErrorKind::usage, cat("kind '", kind.name, "' has integers up to ", high, ", which ",
                                          scalar_name(type), " cannot hold; use int32, uint32, float32 or float64"));
      }
      return;
    case IntegerScaling::stretch:
      break;
  }
  const bool is_signed = limits.lowest < 0.0;
  const double bottom = is_signed ? 0.0 : std::min(low, 0.0);
  const double top = is_signed ? std::max(std::abs(low), std::abs(high)) : high;
  scale_ = top > bottom ? limits.highest / (top - bottom) : 0.0;
  shift_ = -bottom * scale_;
}

void ValuePacker::pack(std::span<const float> values, std::span<std::byte> bytes) const {
  const std::size_t size = scalar_bytes(type_);
  const bool swap = big_endian_ != (std::endian::native == std::endian::big);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, values.size(), 65536), [&](const auto& range) {
    const auto part = values.subspan(range.begin(), range.size());
    std::byte* out = bytes.data() + range.begin() * size;
    switch (type_) {
      case ScalarType::uint8:
        return pack_as<std::uint8_t>(part, scale_, shift_, swap, out);
      case ScalarType::int8:
        return pack_as<std::int8_t>(part, scale_, shift_, swap, out);
      case ScalarType::uint16:
        return pack_as<std::uint16_t>(part, scale_, shift_, swap, out);
      case ScalarType::int16:
        return pack_as<std::int16_t>(part, scale_, shift_, swap, out);
      case ScalarType::uint32:
        return pack_as<std::uint32_t>(part, scale_, shift_, swap, out);
      case ScalarType::int32:
        return pack_as<std::int32_t>(part, scale_, shift_, swap, out);
      case ScalarType::float32:
        return pack_as<float>(part, scale_, shift_, swap, out);
      case ScalarType::float64:
        return pack_as<double>(part, scale_, shift_, swap, out);
      case ScalarType::uint64:
      case ScalarType::int64:
      case ScalarType::float16:
      case ScalarType::bfloat16:
        return;  // refused by the constructor
    }
  });
}

}  // namespace weir
