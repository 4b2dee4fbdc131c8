// Integers that are stored as signed ones and meant as unsigned, or the other way, as NetCDF's attribute _Unsigned
// says: NetCDF-3 had signed ones alone, OPeNDAP unsigned bytes alone.
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

/// The unsigned type of the width of `type`, a signed integer; any other type as it is.
constexpr ScalarType unsigned_type(ScalarType type) {
  for (const IntegerTypes& types : kIntegerTypes) {
    if (types.with_sign == type) return types.without;
  }
  return type;
}

/// The signed type of the width of `type`, an unsigned integer; any other type as it is.
constexpr ScalarType signed_type(ScalarType type) {
  for (const IntegerTypes& types : kIntegerTypes) {
    if (types.without == type) return types.with_sign;
  }
  return type;
}

/// What is said of such values is of the type that they are stored as: -1 stands for the 255 of what is meant as uint8.
/// Of another `type` than an unsigned integer, the value as it is.
inline StoredValue as_unsigned(const StoredValue& value, ScalarType type) {
  const bool meant = signed_type(type) != type;
  const auto* const negative = std::get_if<std::int64_t>(&value);
  if (!meant || negative == nullptr || *negative >= 0) return value;
  const auto bits = static_cast<unsigned>(8 * scalar_bytes(type));
  return static_cast<std::uint64_t>(*negative) & (~std::uint64_t{0} >> (64U - bits));
}

/// The other way: 255 stands for the -1 of what is meant as int8. Of another `type` than a signed integer, the value as
/// it is.
inline StoredValue as_signed(const StoredValue& value, ScalarType type) {
  const bool meant = unsigned_type(type) != type;
  const auto* const natural = std::get_if<std::uint64_t>(&value);
  const auto bits = static_cast<unsigned>(8 * scalar_bytes(type));
  if (!meant || natural == nullptr || *natural < std::uint64_t{1} << (bits - 1)) return value;
  return static_cast<std::int64_t>(*natural | (bits == 64 ? 0 : ~std::uint64_t{0} << bits));
}

/// The type that is meant by _Unsigned = `text`, "true" or "false" in any case; `type` where it is neither.
inline ScalarType meant_type(std::string_view text, ScalarType type) {
  const std::string said = lower_case(text);
  if (said == "true") return unsigned_type(type);
  return said == "false" ? signed_type(type) : type;
}

/// `value` of what is stored in the other of the two types than `type`, which is meant.
inline StoredValue as_meant(const StoredValue& value, ScalarType type) {
  return as_signed(as_unsigned(value, type), type);
}

}  // namespace weir
