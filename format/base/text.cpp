#include "format/base/text.h"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <utility>

namespace weir {
namespace {

template <typename T>
std::optional<T> parse_whole(std::string_view text) {
  T value{};
  const char* end = text.data() + text.size();
  const auto [stop, status] = std::from_chars(text.data(), end, value);
  if (status != std::errc{} || stop != end || text.empty()) return std::nullopt;
  return value;
}

// K, M, G and T are binary, as in other commands.
constexpr std::array<std::pair<std::string_view, double>, 13> kUnits{{{"KiB", 1024.0},
                                                                      {"MiB", 1048576.0},
                                                                      {"GiB", 1073741824.0},
                                                                      {"TiB", 1099511627776.0},
                                                                      {"KB", 1e3},
                                                                      {"MB", 1e6},
                                                                      {"GB", 1e9},
                                                                      {"TB", 1e12},
                                                                      {"B", 1.0},
                                                                      {"K", 1024.0},
                                                                      {"M", 1048576.0},
                                                                      {"G", 1073741824.0},
                                                                      {"T", 1099511627776.0}}};

/// Takes the unit from the end of `text`, and returns its bytes.
double cut_unit(std::string_view& text) {
  double unit = 1.0;
  for (const auto& [name, factor] : kUnits) {
    if (text.ends_with(name)) {
      unit = factor;
      text.remove_suffix(name.size());
      break;
    }
  }
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return unit;
}

}  // namespace

TextPiece::TextPiece(long long value)
    : text_(buffer_.data(), std::to_chars(buffer_.data(), buffer_.data() + buffer_.size(), value).ptr) {}

TextPiece::TextPiece(unsigned long long value)
    : text_(buffer_.data(), std::to_chars(buffer_.data(), buffer_.data() + buffer_.size(), value).ptr) {}

TextPiece::TextPiece(double value)
    : text_(buffer_.data(),
            std::to_chars(buffer_.data(), buffer_.data() + buffer_.size(), value, std::chars_format::general, 9).ptr) {}

std::string concatenate(std::initializer_list<std::string_view> pieces) {
  std::size_t size = 0;
  for (const std::string_view piece : pieces) size += piece.size();
  std::string text;
  text.reserve(size);
  for (const std::string_view piece : pieces) text += piece;
  return text;
}

std::optional<std::int64_t> parse_int(std::string_view text) { return parse_whole<std::int64_t>(text); }

std::optional<double> parse_double(std::string_view text) { return parse_whole<double>(text); }

std::optional<std::uint64_t> parse_bytes(std::string_view text) {
  const double unit = cut_unit(text);
  if (const auto whole = parse_whole<std::uint64_t>(text)) {
    const auto scale = static_cast<std::uint64_t>(unit);
    if (*whole > (std::uint64_t{1} << 62U) / scale) return std::nullopt;
    return *whole * scale;
  }
  const auto number = parse_double(text);
  if (!number || !std::isfinite(*number) || *number < 0) return std::nullopt;
  const double bytes = *number * unit;
  if (bytes != std::floor(bytes) || bytes >= 0x1p62) return std::nullopt;
  return static_cast<std::uint64_t>(bytes);
}

bool is_too_many_bytes(std::string_view text) {
  const double unit = cut_unit(text);
  return parse_double(text).value_or(0) * unit > 0x1p62;
}

std::string format_bytes(std::uint64_t bytes) {
  if (bytes < 1024) return std::to_string(bytes) + " B";
  double value = static_cast<double>(bytes);
  std::size_t unit = 0;
  constexpr std::array<const char*, 5> kNames{"B", "KiB", "MiB", "GiB", "TiB"};
  while (value >= 1024.0 && unit + 1 < kNames.size()) {
    value /= 1024.0;
    ++unit;
  }
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.1f %s", value, kNames[unit]);
  return text.data();
}

std::vector<std::string> split(std::string_view text, char separator) {
  std::vector<std::string> parts;
  std::size_t start = 0;
  for (;;) {
    const std::size_t stop = text.find(separator, start);
    parts.emplace_back(text.substr(start, stop == std::string_view::npos ? stop : stop - start));
    if (stop == std::string_view::npos) return parts;
    start = stop + 1;
  }
}

std::string short_number(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.4g", value);
  return text.data();
}

std::string fixed(double value, int digits) {
  std::array<char, 400> text{};  // the largest double has 309 digits
  std::snprintf(text.data(), text.size(), "%.*f", digits, value);
  return text.data();
}

std::string hex(std::uint64_t value, int digits) {
  std::array<char, 65> text{};
  std::snprintf(text.data(), text.size(), "%0*llx", digits, static_cast<unsigned long long>(value));
  return text.data();
}

}  // namespace weir
