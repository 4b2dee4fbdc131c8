#include "format/base/exact_text.h"

#include <array>
#include <charconv>
#include <sstream>

namespace weir {

std::string exact_text(double value) {
  std::array<char, 32> text{};
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

std::string hex_text(double value) {
  std::ostringstream text;
  text << std::hexfloat << value;
  return text.str();
}

}  // namespace weir
