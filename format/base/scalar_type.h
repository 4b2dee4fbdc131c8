// Scalar types of input volumes: names as on the command line, sizes in bytes.
#pragma once

#include <bit>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace weir {

enum class ScalarType { uint8, int8, uint16, int16, uint32, int32, uint64, int64, float16, bfloat16, float32, float64 };

/// Returns the bytes of one value.
std::size_t scalar_bytes(ScalarType type);
/// Returns "uint8" ... "float64".
std::string_view scalar_name(ScalarType type);
/// Parses a scalar_name() or one of scalar_aliases(); nullopt for anything else.
std::optional<ScalarType> parse_scalar(std::string_view name);
/// The name of a type and, if the text tells it, the byte order.
struct OrderedName {
  std::string_view name;
  std::optional<bool> big_endian;
};
/// Splits numpy's names: "<f4" is "f4", little-endian, ">u2" is "u2", big-endian. "|u1", "=f4" and any other text tell
/// no order.
OrderedName split_byte_order(std::string_view name);
/// Returns all names, comma separated, for messages.
std::string scalar_names();
/// Returns the aliases that C and numpy have for some types: "float, double, u1, ...".
std::string scalar_aliases();

/// The byte order of this machine.
inline constexpr bool kNativeIsBig = std::endian::native == std::endian::big;

}  // namespace weir
