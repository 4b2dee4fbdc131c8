#include "format/packed/symbol_costs.h"

#include <bit>
#include <cmath>

namespace weir {

SymbolCosts symbol_costs(const std::uint16_t* tables) {
  constexpr std::uint32_t total = 1U << kFrequencyBits;
  SymbolCosts costs{};
  for (unsigned context = 0; context < kPackedTables; ++context) {
    const std::uint16_t* table = tables + std::size_t{kPackedSymbols} * context;
    for (unsigned symbol = 0; symbol < kPackedSymbols; ++symbol) {
      const std::uint32_t high = symbol + 1 < kPackedSymbols ? table[symbol + 1] : total;
      const double share = static_cast<double>(high - table[symbol]) / total;
      costs[context][symbol] = static_cast<std::uint16_t>(std::lround(-256 * std::log2(share)));
    }
  }
  return costs;
}

unsigned escape_bits(std::uint32_t high) { return 5 + static_cast<unsigned>(std::bit_width(high - (kEscape - 1)) - 1); }

}  // namespace weir
