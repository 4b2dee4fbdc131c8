// h5py's filter lzf, undone: LibLZF's format, "the simplest of all".
#pragma once

#include <cstddef>
#include <span>

namespace weir {

/// Decodes `stream` into all of `bytes`, and never writes beyond them. A byte below 32 is followed by one literal
/// more than it says; any other one, with the next, tells how many bytes to repeat from how far back (M. Lehmann,
/// LibLZF, lzf_d.c). Throws Error(input), without a place, where the stream is damaged, ends early or holds more.
void unpack_lzf(std::span<const std::byte> stream, std::span<std::byte> bytes);

}  // namespace weir
