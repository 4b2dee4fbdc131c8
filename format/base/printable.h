// Foreign names, made safe for a terminal.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace weir {

/// Bytes of the character that `text` begins with; 0 where it must not reach a terminal as it is: no UTF-8, a control
/// character (those of ASCII, and U+0080 to U+009F), a separator of lines or paragraphs (U+2028, U+2029), or one that
/// turns the direction of the text (U+202A to U+202E, U+2066 to U+2069), by which a name can look like another one.
std::size_t plain_bytes(std::string_view text);

/// `text` with a '?' for each byte that is not plain: a name from a foreign file must not steer the terminal.
std::string printable(const std::string& text);

/// `text` with those bytes as \\n, \\t or \\x1b: one line, from which the name can be typed again.
std::string one_line(const std::string& text);

/// The same with the control characters of ASCII alone: other bytes stay what they are, for Python, whose texts hold
/// any.
std::string one_line_of_bytes(const std::string& text);

}  // namespace weir
