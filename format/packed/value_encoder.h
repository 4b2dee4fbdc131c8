// Encodes the coded values of a packed block, in the format that coefficient_decoder.h reads.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "format/packed/coefficient_decoder.h"
#include "format/packed/row_lanes.h"

namespace weir {

/// Signed values by index: their magnitudes, and words with the highest bit set for negative values.
struct SignedRows {
  const MagnitudeRows& magnitudes;
  std::span<const std::uint32_t, 512> signs;
};

/// The front of a stream: the contents of its bits besides flags and signs.
struct StreamFront {
  unsigned end = 0;          ///< 0 to 32
  unsigned end_bits = 5;     ///< 5: end - 1 is written, 6: end
  std::uint32_t number = 0;  ///< code of the mean, or the base
  unsigned number_bits = 0;
};

/// Returns how many units of kEndUnit places hold all nonzero values of the scan; 0 if all are zero. Place 0 does not
/// count.
unsigned end_of(const MagnitudeRows& magnitudes);
/// Returns end_of() for values with `last_place` as the last nonzero place; 0 means that there is none.
constexpr unsigned end_at(unsigned last_place) { return last_place == 0 ? 0 : last_place / kEndUnit + 1; }

/// The bytes of a stream's two parts; there may be zeros between them.
struct StreamSize {
  std::uint32_t front = 0;  ///< bits besides coded values
  std::uint32_t back = 0;   ///< words and states
};

class ValueEncoder {
 public:
  /// Whether the values are of transformed blocks or of lattice blocks. `tables` are kPackedTables tables as in
  /// BlockConstants.
  enum class Kind { transform, lattice };
  ValueEncoder(const std::uint16_t* tables, Kind kind);

  /// Writes front, words and states to all of `out`, with zeros between front and words. Ignores the values at place 0
  /// and from place kEndUnit * front.end on. Returns false if `out` is too short; `out` then holds anything. Sets
  /// `size`, if given, to the bytes that the parts take.
  bool encode(const StreamFront& front, const SignedRows& values, std::span<std::byte> out,
              StreamSize* size = nullptr) const;

 private:
  // How a symbol of frequency f, which begins at `low`, changes a state x, once x is at most `most`: q = x * inverse >>
  // 44 is x / f, and the new state is x + q * (total - f) + low.
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
