// The tables of the encoder's steps: costs and codes of symbols, levels of contexts, and facts about each
// coefficient. Made once on the host; kernels copy them to shared memory. For host and device.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "format/base/host_device.h"
#include "format/packed/block_constants.h"
#include "format/packed/block_context.h"
#include "format/packed/block_scan.h"
#include "format/packed/coefficient_decoder.h"
#include "format/packed/symbol_costs.h"

namespace weir {

/// Number of symbols of transformed blocks, by band, level and symbol.
inline constexpr unsigned kTransformSymbols = kPackedBands * kPackedLevels * kPackedSymbols;
/// Position of the first symbol of lattice blocks, by level and symbol; then the number of symbols of both.
inline constexpr unsigned kLatticeSymbol = kTransformSymbols;
inline constexpr unsigned kCodedSymbols = kPackedTables * kPackedSymbols;

/// Contexts and costs.
struct alignas(16) CostTables {
  std::uint16_t cost[kCodedSymbols] = {};  ///< in 1/256 bits
  std::uint16_t place[512] = {};           ///< by index: place | weight << 9 | band << 12
  std::uint16_t index[512] = {};           ///< by place
  std::uint8_t level[(kLevelSums + 15) / 16 * 16] = {};

  WEIR_HOST_DEVICE unsigned level_of(std::uint32_t t) const { return level[t < kLevelSums ? t : kLevelSums - 1]; }
};

/// Codes a symbol of frequency f that begins at `low`. x / f equals x * inverse >> 44 for every state x that takes
/// the symbol.
struct SymbolCode {
  std::uint64_t inverse = 0;
  std::uint32_t frequency = 0;
  std::uint32_t low = 0;
};
inline constexpr unsigned kSymbolInverseBits = 44;

struct alignas(16) TransformCodes {
  SymbolCode of[kTransformSymbols] = {};
};

struct alignas(16) CodeTables {
  TransformCodes transform;
  SymbolCode lattice[kPackedLevels * kPackedSymbols] = {};
};

/// Fills the tables from those of a file's constants, on the host.
inline void make_encoder_tables(const std::uint16_t* tables, CostTables& costs, CodeTables& codes) {
  const SymbolCosts symbol_bits = symbol_costs(tables);
  for (unsigned context = 0; context < kPackedTables; ++context) {
    std::copy(symbol_bits[context].begin(), symbol_bits[context].end(), costs.cost + kPackedSymbols * context);
    const std::uint16_t* table = tables + std::size_t{kPackedSymbols} * context;
    for (unsigned s = 0; s < kPackedSymbols; ++s) {
      const std::uint32_t end = s + 1 < kPackedSymbols ? table[s + 1] : 1U << kFrequencyBits;
      const unsigned at = kPackedSymbols * context + s;
      SymbolCode& code = at < kTransformSymbols ? codes.transform.of[at] : codes.lattice[at - kTransformSymbols];
      code.low = table[s];
      code.frequency = end - table[s];
      if (code.frequency == 0) continue;
      code.inverse = ((std::uint64_t{1} << kSymbolInverseBits) + code.frequency - 1) / code.frequency;
    }
  }
  std::copy(std::begin(kBlockScan.level), std::end(kBlockScan.level), costs.level);
  for (unsigned place = 0; place < 512; ++place) {
    costs.index[place] = kBlockScan.index[place];
    costs.place[kBlockScan.index[place]] = static_cast<std::uint16_t>(place | unsigned{kBlockScan.weight[place]} << 9U |
                                                                      unsigned{kBlockScan.band[place]} << 12U);
  }
}

}  // namespace weir
