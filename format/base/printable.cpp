#include "format/base/printable.h"

#include <algorithm>
#include <cstddef>
#include <string_view>

#include "format/base/text.h"
#include "format/base/utf8.h"

namespace weir {
namespace {

bool is_between(std::string_view character, std::string_view first, std::string_view last) {
  // char_traits compares as unsigned bytes.
  return character.size() == first.size() && character >= first && character <= last;
}

template <typename Escape>
std::string escaped(std::string_view text, const Escape& escape) {
  std::string shown;
  while (!text.empty()) {
    const std::size_t plain = plain_bytes(text);
    shown += plain != 0 ? std::string(text.substr(0, plain)) : escape(text.front());
    text.remove_prefix(std::max<std::size_t>(plain, 1));
  }
  return shown;
}

std::string escape_of(char c) {
  if (c == '\n' || c == '\t') return c == '\n' ? "\\n" : "\\t";
  return cat("\\x", hex(static_cast<unsigned char>(c), 2));
}

}  // namespace

std::size_t plain_bytes(std::string_view text) {
  const std::string_view character = text.substr(0, utf8_bytes(text));
  const bool steers = is_between(character, std::string_view("\0", 1), "\x1f") || character == "\x7f" ||
                      is_between(character, "\xc2\x80", "\xc2\x9f") ||
                      is_between(character, "\xe2\x80\xa8", "\xe2\x80\xae") ||  // U+2028 to U+202E
                      is_between(character, "\xe2\x81\xa6", "\xe2\x81\xa9");    // U+2066 to U+2069
  return steers ? 0 : character.size();
}

std::string printable(const std::string& text) {
  return escaped(text, [](char) { return std::string("?"); });
}

std::string one_line(const std::string& text) { return escaped(text, escape_of); }

std::string one_line_of_bytes(const std::string& text) {
  std::string shown;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    shown += byte < 0x20 || byte == 0x7F ? escape_of(c) : std::string(1, c);
  }
  return shown;
}

}  // namespace weir
