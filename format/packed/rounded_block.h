// Streams of a block with values rounded to a lattice of the block's own. For a nearly lossless block they take fewer
// bytes than a transform, because the error of a transform ends at the resolution of float32.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "format/packed/block_encode.h"
#include "format/packed/residuals.h"
#include "format/packed/row_costs.h"

namespace weir {

/// Encodes one block at a time. Use one object per thread.
class RoundedBlock {
 public:
  /// `tables`, with the shape of built_in_tables(), must outlive the object.
  explicit RoundedBlock(const std::uint16_t* tables = built_in_tables());

  /// Takes 512 finite values (x << 6 | y << 3 | z).
  void set(std::span<const float, 512> values);
  /// Returns the least exponent with every |value| below 2^exponent.
  int exponent() const { return exponent_; }

  struct Cost {
    std::uint32_t bytes = 0;  ///< slightly more than the stream takes
    double squared_error = 0;
  };
  /// Returns the cost of the values rounded to multiples of 2^quantum_exponent; nullopt if the lattice or the coder has
  /// no room for them.
  std::optional<Cost> cost(int quantum_exponent);

  /// Writes the stream to all of `out`. If `out` is too short, doubles the quantum until the stream fits. Returns false
  /// if no quantum fits.
  bool encode(int quantum_exponent, std::span<std::byte> out);
  /// Returns whether the last successful encode() doubled the quantum.
  bool coarser() const { return coarser_; }
  /// Computes the values that the stream of the last successful encode() decodes to, with the bits of decode_block()
  /// but without decoding. `constants` are the file's.
  void decoded(const BlockConstants& constants, std::span<float, 512> values) const;

 private:
  bool find_codes(int quantum_exponent);
  bool write(int quantum_exponent, std::span<std::byte> out);

  ValueEncoder coder_;
  RowCosts rows_;
  std::array<float, 512> values_{};
  int exponent_ = 0;
  unsigned predictor_ = 0;   // the best predictor at a medium quantum, used by cost() and encode()
  BlockCodes codes_{};       // codes, counted from the least possible multiple; after write(), from lowest_
  std::int32_t lowest_ = 0;  // the lowest value, in quanta
  double squared_error_ = 0;
  BlockCodes residuals_{};
  MagnitudeRows magnitudes_;
  float minimum_ = 0;  // of the stream that was written last
  float quantum_ = 0;
  bool coarser_ = false;
};

}  // namespace weir
