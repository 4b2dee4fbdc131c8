// Streams of a block whose values are rounded to a lattice of their own: what a nearly lossless one takes fewer bytes
// for than a transformed one, whose error ends at what float32 resolves.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "format/packed/block_encode.h"
#include "format/packed/residuals.h"
#include "format/packed/row_costs.h"

namespace weir {

/// One per thread.
class RoundedBlock {
 public:
  /// `tables`, as built_in_tables(), must outlive the object.
  explicit RoundedBlock(const std::uint16_t* tables = built_in_tables());

  /// Takes 512 finite values (x << 6 | y << 3 | z).
  void set(std::span<const float, 512> values);
  /// The least with every |value| below 2^exponent.
  int exponent() const { return exponent_; }

  struct Cost {
    std::uint32_t bytes = 0;  ///< a little more than the stream takes
    double squared_error = 0;
  };
  /// Rounded to multiples of 2^quantum_exponent; nullopt where the lattice or the coder has no room for them.
  std::optional<Cost> cost(int quantum_exponent);

  /// Writes the stream to all of `out`. Where that is too short the quantum is doubled until it is not; false where
  /// no quantum does.
  bool encode(int quantum_exponent, std::span<std::byte> out);
  /// Whether it was in the last encode(), which gave true.
  bool coarser() const { return coarser_; }
  /// The values that the stream of the last encode(), which gave true, decodes to: decode_block()'s bits, without
  /// decoding it. `constants` has what the file has.
  void decoded(const BlockConstants& constants, std::span<float, 512> values) const;

 private:
  bool find_codes(int quantum_exponent);
  bool write(int quantum_exponent, std::span<std::byte> out);

  ValueEncoder coder_;
  RowCosts rows_;
  std::array<float, 512> values_{};
  int exponent_ = 0;
  unsigned predictor_ = 0;   // the best one at a quantum in the middle, the same for cost() and encode()
  BlockCodes codes_{};       // above the least that there may be; once written, above the lowest
  std::int32_t lowest_ = 0;  // of the values in quanta
  double squared_error_ = 0;
  BlockCodes residuals_{};
  MagnitudeRows magnitudes_;
  float minimum_ = 0;  // of the stream that was written
  float quantum_ = 0;
  bool coarser_ = false;
};

}  // namespace weir
