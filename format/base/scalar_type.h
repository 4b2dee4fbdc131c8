// Scalar types of input volumes: names as on the command line, sizes in bytes.
#pragma once

#include <bit>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace weir {

enum class ScalarType { uint8, int8, uint16, int16, uint32, int32, uint64, int64, float16, float32, float64 };

/// Bytes of one value.
std::size_t scalar_bytes(ScalarType type);
/// "uint8" ... "float64".
std::string_view scalar_name(ScalarType type);
/// Inverse of scalar_name; nullopt for anything else.
std::optional<ScalarType> parse_scalar(std::string_view name);
/// All names, comma separated, for messages.
std::string scalar_names();

/// The byte order of this machine.
inline constexpr bool kNativeIsBig = std::endian::native == std::endian::big;

}  // namespace weir
