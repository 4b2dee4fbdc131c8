// What the coded values of a block cost, for many steps of the quantiser in turn: a row of eight, or two, at once.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "format/packed/coefficient_encoder.h"

namespace weir {

/// Rows of eight magnitudes by index, after eight rows of zeros.
struct MagnitudeRows {
  alignas(64) std::int32_t padded[8 * 72] = {};
  std::uint64_t live = ~std::uint64_t{0};  ///< bit i not set: row i is zero

  std::int32_t* row(unsigned i) { return padded + std::size_t{8} * (i + 8); }
  const std::int32_t* row(unsigned i) const { return padded + std::size_t{8} * (i + 8); }
  std::uint32_t at(unsigned index) const { return static_cast<std::uint32_t>(row(index / 8)[index % 8]); }
};

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
    /// little more than encode_values() takes.
    std::uint32_t stream_bits(unsigned end, unsigned end_bits, unsigned number_bits) const;
  };
  /// Magnitudes are below that.
  static constexpr std::int32_t kMostMagnitude = 1 << 23;
  /// Of places 1 to kEndUnit * end - 1.
  Sum of(const MagnitudeRows& magnitudes, unsigned end) const;

  struct Tables {
    alignas(64) std::int32_t cost[kPackedBands * kPackedLevels * kPackedSymbols + 1];  // the last is 0
    alignas(64) std::int32_t weight[512];                                              // by index
    alignas(64) std::int32_t place[512];
    alignas(64) std::int32_t first_cost[512];  // of symbol 0 at level 0, as an index of cost
    alignas(64) std::int32_t zero_cost[512];   // that entry
    std::int32_t first_place[64];              // the least of each row
  };

 private:
  Tables tables_;
};

}  // namespace weir
