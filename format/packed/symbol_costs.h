// What the symbols of coded values take.
#pragma once

#include <array>
#include <cstdint>

#include "format/packed/coefficient_decoder.h"

namespace weir {

/// Bits that symbols cost, in 1/256, by context and symbol.
using SymbolCosts = std::array<std::array<std::uint16_t, kPackedSymbols>, kPackedTables>;
/// Of the tables of BlockConstants.
SymbolCosts symbol_costs(const std::uint16_t* tables);

/// Bits of an escape, of what is left of a magnitude after its extra bits.
unsigned escape_bits(std::uint32_t high);

}  // namespace weir
