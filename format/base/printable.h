// Makes names from foreign files safe for a terminal.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace weir {

/// Returns the bytes of the character that `text` begins with. Returns 0 if it must not reach a terminal: it is not
/// UTF-8, a control character (ASCII, and U+0080 to U+009F), a separator of lines or paragraphs (U+2028, U+2029), or
/// one that changes the direction of text (U+202A to U+202E, U+2066 to U+2069), which can make one name look like
/// another.
std::size_t plain_bytes(std::string_view text);

/// Returns `text` with a '?' for each byte that is not plain: a name from a foreign file must not control the terminal.
std::string printable(const std::string& text);

/// Returns `text` with each byte that is not plain as \\n, \\t or \\x1b: one line, from which the name can be typed
/// again.
std::string one_line(const std::string& text);

/// Like one_line(), but escapes the control characters of ASCII only: other bytes stay as they are, because Python's
/// texts may hold any.
std::string one_line_of_bytes(const std::string& text);

}  // namespace weir
