// Integers that are stored as signed but meant as unsigned, or the reverse, as NetCDF's attribute _Unsigned says.
// NetCDF-3 had signed integers only, and OPeNDAP has unsigned bytes only.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>

#include "format/base/ascii.h"
#include "format/base/scalar_type.h"
#include "ingest/source/stored_value.h"

namespace weir {

struct IntegerTypes {
  ScalarType with_sign;
  ScalarType without;
};
inline constexpr std::array kIntegerTypes{
    IntegerTypes{ScalarType::int8, ScalarType::uint8}, IntegerTypes{ScalarType::int16, ScalarType::uint16},
    IntegerTypes{ScalarType::int32, ScalarType::uint32}, IntegerTypes{ScalarType::int64, ScalarType::uint64}};

/// Returns the unsigned type of the same width if `type` is a signed integer, otherwise `type`.
constexpr ScalarType unsigned_type(ScalarType type) {
  for (const IntegerTypes& types : kIntegerTypes) {
    if (types.with_sign == type) return types.without;
  }
  return type;
}

/// Returns the signed type of the same width if `type` is an unsigned integer, otherwise `type`.
constexpr ScalarType signed_type(ScalarType type) {
  for (const IntegerTypes& types : kIntegerTypes) {
    if (types.without == type) return types.with_sign;
  }
  return type;
}

/// Returns `value`, given in the stored signed type, as a value of `type`, an unsigned integer: -1 becomes 255 for
/// uint8. For any other `type`, returns `value` unchanged.
inline StoredValue as_unsigned(const StoredValue& value, ScalarType type) {
  const bool meant = signed_type(type) != type;
  const auto* const negative = std::get_if<std::int64_t>(&value);
  if (!meant || negative == nullptr || *negative >= 0) return value;
  const auto bits = static_cast<unsigned>(8 * scalar_bytes(type));
  return static_cast<std::uint64_t>(*negative) & (~std::uint64_t{0} >> (64U - bits));
}

/// Returns `value`, given in the stored unsigned type, as a value of `type`, a signed integer: 255 becomes -1 for
/// int8. For any other `type`, returns `value` unchanged.
inline StoredValue as_signed(const StoredValue& value, ScalarType type) {
  const bool meant = unsigned_type(type) != type;
  const auto* const natural = std::get_if<std::uint64_t>(&value);
  const auto bits = static_cast<unsigned>(8 * scalar_bytes(type));
  if (!meant || natural == nullptr || *natural < std::uint64_t{1} << (bits - 1)) return value;
  return static_cast<std::int64_t>(*natural | (bits == 64 ? 0 : ~std::uint64_t{0} << bits));
}

/// Returns the type that _Unsigned = `text` means: "true" or "false", in upper or lower case. Returns `type` for any
/// other text.
inline ScalarType meant_type(std::string_view text, ScalarType type) {
  const std::string said = lower_case(text);
  if (said == "true") return unsigned_type(type);
  return said == "false" ? signed_type(type) : type;
}

/// Returns `value`, which may be given in the stored type of the other signedness, as a value of the meant type
/// `type`.
inline StoredValue as_meant(const StoredValue& value, ScalarType type) {
  return as_signed(as_unsigned(value, type), type);
}

}  // namespace weir
