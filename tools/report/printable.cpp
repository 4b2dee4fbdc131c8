#include "tools/report/printable.h"

#include <algorithm>
#include <cstddef>
#include <string_view>

#include "format/base/text.h"

namespace weir {
namespace {

/// Bytes of the character that `text` begins with; 0 where that is a control character or no UTF-8 (Unicode 15, table
/// 3-7: no overlong form, no surrogate, nothing above U+10FFFF).
std::size_t character_bytes(std::string_view text) {
  const auto at = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U; };
  const auto follows = [&](std::size_t i, unsigned least = 0x80, unsigned most = 0xBF) {
    return at(i) >= least && at(i) <= most;
  };
  const unsigned first = at(0);
  if (first < 0x80) return first >= 0x20 && first != 0x7F ? 1 : 0;
  if (first >= 0xC2 && first <= 0xDF) return follows(1, first == 0xC2 ? 0xA0 : 0x80) ? 2 : 0;
  if (first >= 0xE0 && first <= 0xEF) {
    return follows(1, first == 0xE0 ? 0xA0 : 0x80, first == 0xED ? 0x9F : 0xBF) && follows(2) ? 3 : 0;
  }
  if (first >= 0xF0 && first <= 0xF4) {
    return follows(1, first == 0xF0 ? 0x90 : 0x80, first == 0xF4 ? 0x8F : 0xBF) && follows(2) && follows(3) ? 4 : 0;
  }
  return 0;
}

template <typename Escape>
std::string escaped(std::string_view text, const Escape& escape) {
  std::string shown;
  while (!text.empty()) {
    const std::size_t plain = character_bytes(text);
    shown += plain != 0 ? std::string(text.substr(0, plain)) : escape(text.front());
    text.remove_prefix(std::max<std::size_t>(plain, 1));
  }
  return shown;
}

}  // namespace

std::string printable(const std::string& text) {
  return escaped(text, [](char) { return std::string("?"); });
}

std::string one_line(const std::string& text) {
  return escaped(text, [](char c) {
    if (c == '\n' || c == '\t') return std::string(c == '\n' ? "\\n" : "\\t");
    return cat("\\x", hex(static_cast<unsigned char>(c), 2));
  });
}

}  // namespace weir
