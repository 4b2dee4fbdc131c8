// What the coded values of a block cost, for many steps of the quantiser in turn: a row of eight, or two, at once.
#pragma once

#include <cstdint>

#include "format/packed/row_lanes.h"
#include "format/packed/symbol_costs.h"

namespace weir {

class RowCosts {
 public:
  /// Of the contexts of transformed blocks in those tables, or of lattice blocks.
  enum class Contexts { transform, lattice };
  explicit RowCosts(const SymbolCosts& costs, Contexts contexts = Contexts::transform);

  struct Sum {
    std::uint32_t symbols = 0;  ///< in 1/256 bits
    std::uint32_t raw = 0;      ///< bits of escapes and extra ones
    std::uint32_t nonzero = 0;

    /// Bits of a stream that is so coded besides those of its number, of which `number_bits` or more come first; a
    /// little more than ValueEncoder takes.
    std::uint32_t stream_bits(unsigned end, unsigned end_bits, unsigned number_bits) const;
  };
  /// Magnitudes are below that.
  static constexpr std::int32_t kMostMagnitude = 1 << 23;
  /// Of places 1 to kEndUnit * end - 1.
  Sum of(const MagnitudeRows& magnitudes, unsigned end) const;

  struct Tables {
    alignas(64) std::int32_t cost[kPackedBands * kPackedLevels * kPackedSymbols + 1];  // the last is 0
    alignas(64) std::int32_t zero_cost[512];  // of symbol 0 at level 0, by index
    const RowPlaces* places;
  };

 private:
  Tables tables_;
};

}  // namespace weir
