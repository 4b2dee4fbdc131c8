#include "ingest/values/decode_doubles.h"

#include <array>
#include <cstdint>
#include <limits>
#include <variant>

#include "format/base/error.h"
#include "format/base/load_scalar.h"
#include "ingest/values/convert_values.h"
#include "ingest/values/half_values.h"

namespace weir {
namespace {

float load_half(std::span<const std::byte> bytes, ScalarType type, bool big_endian) {
  std::array<float, 1> value{};
  convert_values(bytes.first(2), type, big_endian, value);
  return value[0];
}

template <typename T>
bool is_same(T stored, const StoredValue& missing) {
  return std::visit(
      [&](auto value) {
        const auto other = static_cast<T>(value);
        return stored == other || (stored != stored && other != other);
      },
      missing);
}

template <typename T>
double decoded(T stored, ScalarType type, const ValueMapping& mapping) {
  for (const StoredValue& value : mapping.missing) {
    if (holds(type, value) && is_same(stored, value)) return std::numeric_limits<double>::quiet_NaN();
  }
  return mapping.scales() ? static_cast<double>(mapping.scaled(stored)) : static_cast<double>(stored);
}

template <typename T>
double decode_as(std::span<const std::byte> bytes, ScalarType type, bool big_endian, const ValueMapping& mapping) {
  return decoded(load_scalar<T>(bytes.data(), big_endian), type, mapping);
}

double decode_one(std::span<const std::byte> bytes, ScalarType type, bool big, const ValueMapping& mapping) {
  switch (type) {
    case ScalarType::uint8:
      return decode_as<std::uint8_t>(bytes, type, big, mapping);
    case ScalarType::int8:
      return decode_as<std::int8_t>(bytes, type, big, mapping);
    case ScalarType::uint16:
      return decode_as<std::uint16_t>(bytes, type, big, mapping);
    case ScalarType::int16:
      return decode_as<std::int16_t>(bytes, type, big, mapping);
    case ScalarType::uint32:
      return decode_as<std::uint32_t>(bytes, type, big, mapping);
    case ScalarType::int32:
      return decode_as<std::int32_t>(bytes, type, big, mapping);
    case ScalarType::uint64:
      return decode_as<std::uint64_t>(bytes, type, big, mapping);
    case ScalarType::int64:
      return decode_as<std::int64_t>(bytes, type, big, mapping);
    case ScalarType::float16:
    case ScalarType::bfloat16:
      return decoded(load_half(bytes, type, big), ScalarType::float32, mapping);
    case ScalarType::float32:
      return decode_as<float>(bytes, type, big, mapping);
    case ScalarType::float64:
      return decode_as<double>(bytes, type, big, mapping);
  }
  throw Error(ErrorKind::internal, "unknown type of values");
}

}  // namespace

std::vector<double> decode_doubles(std::span<const std::byte> bytes, ScalarType type, bool big_endian,
                                   const ValueMapping& mapping) {
  const std::size_t size = scalar_bytes(type);
  const bool half = type == ScalarType::float16 || type == ScalarType::bfloat16;
  const ValueMapping stored = half ? with_stored_missing(mapping, type) : mapping;
  std::vector<double> values;
  values.reserve(bytes.size() / size);
  for (std::size_t at = 0; at + size <= bytes.size(); at += size) {
    values.push_back(decode_one(bytes.subspan(at, size), type, big_endian, stored));
  }
  return values;
}

}  // namespace weir
