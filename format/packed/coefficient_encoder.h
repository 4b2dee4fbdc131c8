// Encodes the coded values of a packed block: what coefficient_decoder.h reads.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "format/packed/coefficient_decoder.h"

namespace weir {

/// A signed value of each place of the scan, kept as magnitude and sign. Places from kEndUnit * end on are 0.
struct ScanValues {
  std::array<std::uint32_t, 512> magnitudes{};
  std::array<bool, 512> negative{};
};

/// The front of a stream: what its bits hold besides flags and signs.
struct StreamFront {
  unsigned end = 0;          ///< 0 to 32
  unsigned end_bits = 5;     ///< 5: end - 1 is written, 6: end
  std::uint32_t number = 0;  ///< code of the mean, or the base
  unsigned number_bits = 0;
};

/// Of the last place that is not zero, in units of kEndUnit places, rounded up; 0 where all are.
unsigned end_of(const ScanValues& values);

/// Bytes of a stream's two parts, between which there may be zeros.
struct StreamSize {
  std::uint32_t front = 0;  ///< bits besides coded values
  std::uint32_t back = 0;   ///< words and states
};

/// Writes front, words and states to all of `out`, zeros between them. False where that is too short; `out` is then
/// anything. `size`, where given, becomes what they take.
bool encode_values(const CoderContexts& contexts, const StreamFront& front, const ScanValues& values,
                   std::span<std::byte> out, StreamSize* size = nullptr);

/// Bits that symbols cost, in 1/256, by context and symbol.
using SymbolCosts = std::array<std::array<std::uint16_t, kPackedSymbols>, kPackedTables>;
SymbolCosts symbol_costs(const std::uint16_t* tables);

/// Contexts of the codes of lattice blocks among the tables of all.
inline const std::uint16_t* lattice_tables(const std::uint16_t* tables) {
  return tables + std::size_t{kPackedSymbols} * kPackedLevels * kPackedBands;
}

/// Bits of an escape, of what is left of a magnitude after its extra bits.
unsigned escape_bits(std::uint32_t high);

}  // namespace weir
