// Text for messages and options: concatenation, byte sizes, numbers.
#pragma once

#include <array>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace weir {

/// One argument of cat() as text; numbers in a buffer of its own.
class TextPiece {
 public:
  TextPiece(std::string_view text) : text_(text) {}
  TextPiece(const std::string& text) : text_(text) {}
  TextPiece(const char* text) : text_(text) {}
  TextPiece(char c) : buffer_{c}, text_(buffer_.data(), 1) {}
  TextPiece(bool value) : TextPiece(value ? '1' : '0') {}
  TextPiece(int value) : TextPiece(static_cast<long long>(value)) {}
  TextPiece(long value) : TextPiece(static_cast<long long>(value)) {}
  TextPiece(long long value);
  TextPiece(unsigned value) : TextPiece(static_cast<unsigned long long>(value)) {}
  TextPiece(unsigned long value) : TextPiece(static_cast<unsigned long long>(value)) {}
  TextPiece(unsigned long long value);
  TextPiece(float value) : TextPiece(static_cast<double>(value)) {}
  TextPiece(double value);
  TextPiece(const TextPiece&) = delete;
  TextPiece& operator=(const TextPiece&) = delete;

  std::string_view text() const { return text_; }

 private:
  std::array<char, 32> buffer_;
  std::string_view text_;
};

std::string concatenate(std::initializer_list<std::string_view> pieces);

/// All arguments one after the other; floating-point numbers with up to 9 significant digits. Not a template of
/// streams, since it is called in a thousand places, each of which would be compiled for longer.
template <typename... Args>
std::string cat(const Args&... args) {
  return concatenate({TextPiece(args).text()...});
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

/// With four significant digits: for people.
std::string short_number(double value);

/// With that many digits behind the point.
std::string fixed(double value, int digits);

/// In hexadecimal, with leading zeros up to that many digits.
std::string hex(std::uint64_t value, int digits = 1);

}  // namespace weir
