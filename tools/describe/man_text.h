// Text in the language of man(7).
#pragma once

#include <string>

namespace weir {

/// Text as man(7) takes it: no character of it is a request, dashes can be searched for and copied.
std::string man_escaped(const std::string& text);
/// Escaped, in bold.
std::string man_bold(const std::string& text);
/// Escaped, in italics.
std::string man_italic(const std::string& text);

}  // namespace weir
