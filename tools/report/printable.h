// Foreign names, made safe for a terminal.
#pragma once

#include <algorithm>
#include <string>

#include "format/base/text.h"

namespace weir {

/// `text` with its control characters as '?': a name from a foreign file must not steer the terminal.
inline std::string printable(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 32 || c == 127; }, '?');
  return text;
}

/// `text` with its control characters as \\n, \\t or \\x1b: one line, from which the name can be typed again.
inline std::string one_line(const std::string& text) {
  std::string line;
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (code >= 32 && code != 127) {
      line += c;
    } else if (c == '\n' || c == '\t') {
      line += c == '\n' ? "\\n" : "\\t";
    } else {
      line += cat("\\x", hex(code, 2));
    }
  }
  return line;
}

}  // namespace weir
