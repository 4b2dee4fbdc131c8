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

/// One argument of cat() as text; a number is written into a buffer of the object.
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

/// Joins all arguments; floating-point numbers get up to 9 significant digits. Streams are not used, because cat() is
/// called in a thousand places and each would take longer to compile.
template <typename... Args>
std::string cat(const Args&... args) {
  return concatenate({TextPiece(args).text()...});
}

/// Parses "512MiB", "1.5GB", "4096" or "4096B" as bytes (B KB MB GB TB are powers of 1000, KiB ... TiB powers of 1024;
/// K M G T mean KiB ... TiB). Returns nullopt if the text is not a size, is negative, is not a whole number of bytes,
/// or is above 2^62.
std::optional<std::uint64_t> parse_bytes(std::string_view text);
/// Returns whether the text is a size above 2^62 bytes, which parse_bytes() refuses for that alone.
bool is_too_many_bytes(std::string_view text);
/// Returns "512.0 MiB" or "17 B", for people; it is never parsed back.
std::string format_bytes(std::uint64_t bytes);
/// Parse the whole text as an integer or a double; nullopt if anything is left over or out of range.
std::optional<std::int64_t> parse_int(std::string_view text);
std::optional<double> parse_double(std::string_view text);
/// Returns the parts between separators, including empty parts.
std::vector<std::string> split(std::string_view text, char separator);

/// Returns `value` with four significant digits, for people.
std::string short_number(double value);

/// Returns `value` with `digits` digits behind the point.
std::string fixed(double value, int digits);

/// Returns `value` in hexadecimal, with leading zeros up to `digits` digits.
std::string hex(std::uint64_t value, int digits = 1);

}  // namespace weir
