// Integers that are stored as signed ones and meant as unsigned, as NetCDF's attribute _Unsigned says: NetCDF-3 had no
// others.
#pragma once

#include <cstdint>
#include <variant>

#include "format/base/scalar_type.h"
#include "ingest/source/stored_value.h"

namespace weir {

/// The unsigned type of the width of `type`, a signed integer; any other type as it is.
constexpr ScalarType unsigned_type(ScalarType type) {
  switch (type) {
    case ScalarType::int8:
      return ScalarType::uint8;
    case ScalarType::int16:
      return ScalarType::uint16;
    case ScalarType::int32:
      return ScalarType::uint32;
    case ScalarType::int64:
      return ScalarType::uint64;
    default:
      return type;
  }
}

/// What is said of such values is of the type that they are stored as: -1 stands for the 255 of what is meant as uint8.
/// Of another `type` than an unsigned integer, the value as it is.
inline StoredValue as_unsigned(const StoredValue& value, ScalarType type) {
  const bool meant = type == ScalarType::uint8 || type == ScalarType::uint16 || type == ScalarType::uint32 ||
                     type == ScalarType::uint64;
  const auto* const negative = std::get_if<std::int64_t>(&value);
  if (!meant || negative == nullptr || *negative >= 0) return value;
  const auto bits = static_cast<unsigned>(8 * scalar_bytes(type));
  return static_cast<std::uint64_t>(*negative) & (~std::uint64_t{0} >> (64U - bits));
}

}  // namespace weir
