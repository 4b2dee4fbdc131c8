#include "tools/describe/man_text.h"

#include "format/base/text.h"

namespace weir {

std::string man_escaped(const std::string& text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool starts_line = i == 0 || text[i - 1] == '\n';
    if (starts_line && (text[i] == '.' || text[i] == '\'')) result += "\\&";
    if (text[i] == '\\') {
      result += "\\e";
    } else if (text[i] == '-') {
      result += "\\-";
    } else {
      result += text[i];
    }
  }
  return result;
}

std::string man_bold(const std::string& text) { return cat("\\fB", man_escaped(text), "\\fR"); }
std::string man_italic(const std::string& text) { return cat("\\fI", man_escaped(text), "\\fR"); }

}  // namespace weir
