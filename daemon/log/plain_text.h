// Foreign names in logs and lists, which people read on terminals.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace weir {

/// Bytes of the character that `text` begins with; 0 where it must not reach a terminal as it is: no UTF-8, a control
/// character (those of ASCII, and U+0080 to U+009F), a separator of lines or paragraphs (U+2028, U+2029), or one that
/// turns the direction of the text (U+202A to U+202E, U+2066 to U+2069), by which a name can look like another one.
std::size_t plain_bytes(std::string_view text);

/// `text` with a '?' for each byte that is not plain.
std::string masked_text(std::string_view text);

}  // namespace weir
