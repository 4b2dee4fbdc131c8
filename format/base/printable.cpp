#include "format/base/printable.h"

#include <algorithm>
#include <cstddef>
#include <string_view>

#include "format/base/text.h"
#include "format/base/utf8.h"

namespace weir {
namespace {

/// Bytes of the character that `text` begins with; 0 where that is a control character or no UTF-8.
std::size_t shown_bytes(std::string_view text) {
  const auto first = static_cast<unsigned char>(text.front());
  if (first < 0x20 || first == 0x7F) return 0;
  const std::size_t bytes = utf8_bytes(text);
  const bool control = bytes == 2 && first == 0xC2 && static_cast<unsigned char>(text[1]) < 0xA0;  // to U+009F
  return control ? 0 : bytes;
}

template <typename Escape>
std::string escaped(std::string_view text, const Escape& escape) {
  std::string shown;
  while (!text.empty()) {
    const std::size_t plain = shown_bytes(text);
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
