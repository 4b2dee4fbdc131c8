// Text for messages and options: concatenation, byte sizes, numbers.
#pragma once

#include <cstdint>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace weir {

/// All arguments streamed into one string; doubles with up to 9 significant digits.
template <typename... Args>
std::string cat(const Args&... args) {
  std::ostringstream out;
  out.precision(9);
  (out << ... << args);
  return out.str();
}

/// "512MiB", "1.5GB", "4096", "4096B" in bytes (B KB MB GB TB are powers of 1000, KiB ... TiB
/// powers of 1024). nullopt where the text is no size, is negative, or is no whole number of bytes
/// below 2^63.
std::optional<std::uint64_t> parse_bytes(std::string_view text);
/// "512.0 MiB", "17 B": for people, never parsed back.
std::string format_bytes(std::uint64_t bytes);
/// Whole text as an integer or a double; nullopt where anything is left over or out of range.
std::optional<std::int64_t> parse_int(std::string_view text);
std::optional<double> parse_double(std::string_view text);
/// Parts between `separator`, none dropped.
std::vector<std::string> split(std::string_view text, char separator);

}  // namespace weir
