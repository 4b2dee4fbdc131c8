// Counts the codes that the values of a leaf take.
#pragma once

#include <cstdint>
#include <span>

namespace weir {

/// Returns how many of the codes below 2^bits occur more than `few` times in `codes`. `bits` is 1 to 8, and `codes` has
/// at most 512 entries.
unsigned taken_codes(std::span<const std::uint16_t> codes, unsigned bits, unsigned few);

}  // namespace weir
