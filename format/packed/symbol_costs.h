// The costs in bits of the symbols of coded values.
#pragma once

#include <array>
#include <cstdint>

#include "format/packed/coefficient_decoder.h"

namespace weir {

/// Costs of symbols, in 1/256 bits, by context and symbol.
using SymbolCosts = std::array<std::array<std::uint16_t, kPackedSymbols>, kPackedTables>;
/// Returns the costs for tables as in BlockConstants.
SymbolCosts symbol_costs(const std::uint16_t* tables);

/// Returns the bits of an escape for `high`, the part of a magnitude above its extra bits.
unsigned escape_bits(std::uint32_t high);

}  // namespace weir
