// Names from elsewhere, for a terminal.
#pragma once

#include <algorithm>
#include <string>

namespace weir {

/// `text` with its control characters as '?': a name from a foreign file must not steer the terminal.
inline std::string printable(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 32 || c == 127; }, '?');
  return text;
}

}  // namespace weir
