// Encodes a block by transform: what each step of the quantiser costs and loses, and the stream. No dependency on the
// rest of weir.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "format/packed/block_constants.h"
#include "format/packed/quantiser.h"
#include "format/packed/row_costs.h"
#include "format/packed/value_encoder.h"

namespace weir {

/// Returns the tables that weir writes: kPackedTables x kPackedSymbols cumulative frequencies, measured over the
/// volumes and steps that docs/internals.md names.
const std::uint16_t* built_in_tables();

/// Returns the bytes of a stream that has `bits` bits besides the code of its mean.
inline std::uint32_t stream_bytes(std::uint32_t bits, unsigned mean_bits) { return (bits + mean_bits + 7) / 8; }

/// Encodes one block at a time. Use one object per thread.
class TransformBlock {
 public:
  /// `tables`, with the shape of built_in_tables(), must outlive the object.
  explicit TransformBlock(const std::uint16_t* tables = built_in_tables());

  /// Transforms 512 finite values (x << 6 | y << 3 | z). Returns false if they are too large or too small for a
  /// transform.
  bool set(std::span<const float, 512> values);
  float mean() const { return mean_; }
  /// Over all coefficients except the mean's: the largest magnitude, and the sum of squares, which is the squared error
  /// of a stream of the mean alone.
  double largest() const { return largest_; }
  double energy() const { return energy_; }

  struct Cost {
    std::uint32_t bits = 0;    ///< bits of the stream without the mean's code; 8: a mean alone
    double squared_error = 0;  ///< of the 512 values, by Parseval's theorem, without the mean's own error
  };
  /// Returns the cost at a step number. The bits are what encode() writes, to a fraction of a bit.
  Cost cost(std::int32_t step);

  /// Writes the stream to all of `out`. If `out` is too short, drops the smallest coefficients until the stream fits;
  /// if it is longer, puts zeros in the stream's middle. `constants` are the file's.
  void encode(const BlockConstants& constants, const MeanRange& range, std::int32_t step, std::span<std::byte> out);
  /// Returns whether the last encode() has dropped coefficients.
  bool dropped() const { return dropped_; }
  /// Computes the values that the stream of the last encode() decodes to, with the bits of decode_block() but without
  /// decoding. The arguments are those of that encode(). Returns false if the stream is a mean alone.
  bool decoded(const BlockConstants& constants, const MeanRange& range, std::int32_t step,
               std::span<float, 512> values) const;

 private:
  ValueEncoder coder_;
  RowCosts rows_;
  float mean_ = 0;
  double largest_ = 0;
  double energy_ = 0;
  std::array<float, 512> coefficients_{};  // by index; the mean's entry is 0
  std::array<float, 64> row_largest_{};
  std::array<double, 64> row_energy_{};
  MagnitudeRows magnitudes_;
  StreamFront front_;  // front of the last encode()'s stream
  bool dropped_ = false;
};

}  // namespace weir
