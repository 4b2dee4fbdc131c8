#include "ingest/source/stored_value.h"

#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <system_error>
#include <type_traits>
#include <utility>

#include "format/base/text.h"

namespace weir {
namespace {

template <typename T>
bool holds_integer(const StoredValue& value) {
  return std::visit(
      [](const auto v) {
        if constexpr (std::is_floating_point_v<std::decay_t<decltype(v)>>) {
          // The bound is one above the type's maximum. This is a power of two, which a double holds exactly; the
          // maximum itself it may not hold.
          constexpr double kEnd = static_cast<double>(std::numeric_limits<T>::max() / 2 + 1) * 2;
          return v >= static_cast<double>(std::numeric_limits<T>::lowest()) && v < kEnd && std::trunc(v) == v;
        } else {
          return std::in_range<T>(v);
        }
      },
      value);
}

// Returns whether `value` is not finite or rounds to a finite value. `end` lies half a step above the largest finite
// value of the type.
bool holds_real(const StoredValue& value, double end) {
  const double v = as_double(value);
  return !std::isfinite(v) || std::fabs(v) < end;
}

}  // namespace

std::optional<StoredValue> parse_stored_value(std::string_view text) {
  if (const auto integer = parse_int(text)) return StoredValue{*integer};
  std::uint64_t large = 0;
  const char* const end = text.data() + text.size();
  if (const auto [rest, error] = std::from_chars(text.data(), end, large); error == std::errc{} && rest == end) {
    return StoredValue{large};
  }
  if (const auto number = parse_double(text)) return StoredValue{*number};
  return std::nullopt;
}

std::string stored_value_text(const StoredValue& value) {
  std::array<char, 32> text{};
  const auto written =
      std::visit([&](const auto v) { return std::to_chars(text.data(), text.data() + text.size(), v); }, value);
  return {text.data(), written.ptr};
}

double as_double(const StoredValue& value) {
  return std::visit([](const auto v) { return static_cast<double>(v); }, value);
}

bool holds(ScalarType type, const StoredValue& value) {
  switch (type) {
    case ScalarType::uint8:
      return holds_integer<std::uint8_t>(value);
    case ScalarType::int8:
      return holds_integer<std::int8_t>(value);
    case ScalarType::uint16:
      return holds_integer<std::uint16_t>(value);
    case ScalarType::int16:
      return holds_integer<std::int16_t>(value);
    case ScalarType::uint32:
      return holds_integer<std::uint32_t>(value);
    case ScalarType::int32:
      return holds_integer<std::int32_t>(value);
    case ScalarType::uint64:
      return holds_integer<std::uint64_t>(value);
    case ScalarType::int64:
      return holds_integer<std::int64_t>(value);
    case ScalarType::float16:
      return holds_real(value, 65520);
    case ScalarType::bfloat16:
      return holds_real(value, 0x1.FFp127);
    case ScalarType::float32:
      return holds_real(value, 0x1.FFFFFFp127);
    case ScalarType::float64:
      return true;
  }
  return false;
}

}  // namespace weir
