// Scalar types of input volumes: names as on the command line, sizes in bytes.
#pragma once

#include <bit>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace weir {

enum class ScalarType { uint8, int8, uint16, int16, uint32, int32, uint64, int64, float16, bfloat16, float32, float64 };

/// Bytes of one value.
std::size_t scalar_bytes(ScalarType type);
/// "uint8" ... "float64".
std::string_view scalar_name(ScalarType type);
/// By scalar_name or one of scalar_aliases(); nullopt for anything else.
std::optional<ScalarType> parse_scalar(std::string_view name);
/// A type's name, and which end of a value comes first, where the text says it.
struct OrderedName {
  std::string_view name;
  std::optional<bool> big_endian;
};
/// numpy's "<f4" and ">u2" are "f4", little-endian, and "u2", big-endian; "|u1" and "=f4", like any other text, say no
/// order.
OrderedName split_byte_order(std::string_view name);
/// All names, comma separated, for messages.
std::string scalar_names();
/// C's and numpy's for some of them: "float, double, u1, ...".
std::string scalar_aliases();

/// The byte order of this machine.
inline constexpr bool kNativeIsBig = std::endian::native == std::endian::big;

}  // namespace weir
