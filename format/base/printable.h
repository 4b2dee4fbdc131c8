// Foreign names, made safe for a terminal.
#pragma once

#include <string>

namespace weir {

/// `text` with a '?' for each byte of its control characters (those of ASCII, and U+0080 to U+009F) and for each that
/// is no UTF-8: a name from a foreign file must not steer the terminal.
std::string printable(const std::string& text);

/// `text` with those bytes as \\n, \\t or \\x1b: one line, from which the name can be typed again.
std::string one_line(const std::string& text);

/// The same with the control characters of ASCII alone: other bytes stay what they are, for Python, whose texts hold
/// any.
std::string one_line_of_bytes(const std::string& text);

}  // namespace weir
