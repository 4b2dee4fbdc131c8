// How many codes the values of a leaf take.
#pragma once

#include <cstdint>
#include <span>

namespace weir {

/// How many of the codes below 2^bits (1 to 8) more than `few` of `codes` are, of which there are at most 512.
unsigned taken_codes(std::span<const std::uint16_t> codes, unsigned bits, unsigned few);

}  // namespace weir
