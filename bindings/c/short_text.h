// Texts in arrays of a fixed length.
#pragma once

#include <span>
#include <string_view>

namespace weir::c {

/// Copies `text`, which is UTF-8, to `out` with a zero at its end. "..." replaces the middle of a text that is too
/// long: a message begins with the place and ends with the cause and what to do. No character of UTF-8 is cut. `out`
/// has at least 8 bytes. Needs no memory.
void copy_shortened(std::string_view text, std::span<char> out) noexcept;

}  // namespace weir::c
