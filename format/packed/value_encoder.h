// Encodes the coded values of a packed block: what coefficient_decoder.h reads.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "format/packed/coefficient_decoder.h"
#include "format/packed/row_lanes.h"

namespace weir {

/// Signed values by index: their magnitudes, and words whose highest bit is set where they are negative.
struct SignedRows {
  const MagnitudeRows& magnitudes;
  std::span<const std::uint32_t, 512> signs;
};

/// The front of a stream: what its bits hold besides flags and signs.
struct StreamFront {
  unsigned end = 0;          ///< 0 to 32
  unsigned end_bits = 5;     ///< 5: end - 1 is written, 6: end
  std::uint32_t number = 0;  ///< code of the mean, or the base
  unsigned number_bits = 0;
};

/// How many units of kEndUnit places hold all values of the scan that are not zero; 0 where all are zero. Place 0 does
/// not count.
unsigned end_of(const MagnitudeRows& magnitudes);
/// The same where `last_place` is the last one that is not zero; it is 0 where there is none.
constexpr unsigned end_at(unsigned last_place) { return last_place == 0 ? 0 : last_place / kEndUnit + 1; }

/// Bytes of a stream's two parts, between which there may be zeros.
struct StreamSize {
  std::uint32_t front = 0;  ///< bits besides coded values
  std::uint32_t back = 0;   ///< words and states
};

class ValueEncoder {
 public:
  /// Of transformed blocks, or of lattice blocks, by kPackedTables tables as in BlockConstants.
  enum class Kind { transform, lattice };
  ValueEncoder(const std::uint16_t* tables, Kind kind);

  /// Writes front, words and states to all of `out`, zeros between them. Values from place kEndUnit * front.end on, and
  /// that of place 0, are not looked at. False where `out` is too short; it is then anything. `size`, where given,
  /// becomes what they take.
  bool encode(const StreamFront& front, const SignedRows& values, std::span<std::byte> out,
              StreamSize* size = nullptr) const;

 private:
  // What a symbol of frequency f from `low` on makes of a state x, once that is at most `most`: f goes into it
  // x * inverse >> 44 times, and what that leaves is x + that * (total - f) + low.
  struct Symbol {
    std::uint64_t inverse = 0;
    std::uint64_t most = 0;
    std::uint32_t complement = 0;  // total - f
    std::uint32_t low = 0;
  };
  class Words;
  template <unsigned States>
  void put_values(const StreamFront& front, const MagnitudeRows& magnitudes, std::uint32_t (&states)[2],
                  Words& words) const;

  bool bands_;
  std::array<Symbol, kPackedBands * kPackedLevels * kPackedSymbols> symbols_{};
};

}  // namespace weir
