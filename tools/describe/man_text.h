// Formats text in the language of man(7).
#pragma once

#include <string>

namespace weir {

/// Returns `text` escaped for man(7): no character is taken as a request, and dashes can be searched for and copied.
std::string man_escaped(const std::string& text);
/// Returns `text` escaped and in bold.
std::string man_bold(const std::string& text);
/// Returns `text` escaped and in italics.
std::string man_italic(const std::string& text);

}  // namespace weir
