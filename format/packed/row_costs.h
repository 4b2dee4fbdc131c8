// Computes the cost of a block's coded values for many steps of the quantiser in turn, one or two rows of eight at a
// time.
#pragma once

#include <cstdint>

#include "format/packed/row_lanes.h"
#include "format/packed/symbol_costs.h"

namespace weir {

class RowCosts {
 public:
  /// Which contexts of the tables the values use: those of transformed blocks or those of lattice blocks.
  enum class Contexts { transform, lattice };
  explicit RowCosts(const SymbolCosts& costs, Contexts contexts = Contexts::transform);

  struct Sum {
    std::uint32_t symbols = 0;  ///< in 1/256 bits
    std::uint32_t raw = 0;      ///< bits of escapes and extra bits
    std::uint32_t nonzero = 0;

    /// Returns the bits of a stream with these values, without those of its number. The number has `number_bits` bits
    /// or more. The result is slightly more than ValueEncoder writes.
    std::uint32_t stream_bits(unsigned end, unsigned end_bits, unsigned number_bits) const;
  };
  /// Magnitudes are below this.
  static constexpr std::int32_t kMostMagnitude = 1 << 23;
  /// Returns the cost of places 1 to kEndUnit * end - 1.
  Sum of(const MagnitudeRows& magnitudes, unsigned end) const;

  struct Tables {
    alignas(64) std::int32_t cost[kPackedBands * kPackedLevels * kPackedSymbols + 1];  // the last entry is 0
    alignas(64) std::int32_t zero_cost[512];  // cost of symbol 0 at level 0, by index
    const RowPlaces* places;
  };

 private:
  Tables tables_;
};

}  // namespace weir
