// Encodes a block by transform: what each step of the quantiser takes and loses, and the stream. No dependency on the
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

/// The tables that weir writes: kPackedTables x kPackedSymbols cumulative frequencies, of the volumes and steps that
/// docs/internals.md names.
const std::uint16_t* built_in_tables();

/// Bytes of a stream of so many bits besides the code of its mean.
inline std::uint32_t stream_bytes(std::uint32_t bits, unsigned mean_bits) { return (bits + mean_bits + 7) / 8; }

/// One per thread.
class TransformBlock {
 public:
  /// `tables`, as built_in_tables(), must outlive the object.
  explicit TransformBlock(const std::uint16_t* tables = built_in_tables());

  /// Transforms 512 finite values (x << 6 | y << 3 | z). False where they are too large or too small for that.
  bool set(std::span<const float, 512> values);
  float mean() const { return mean_; }
  /// Of the coefficients but the mean's: the largest magnitude, and the sum of squares, which is the squared error of
  /// the mean alone.
  double largest() const { return largest_; }
  double energy() const { return energy_; }

  struct Cost {
    std::uint32_t bits = 0;    ///< of the stream but for the mean's code; 8: a mean alone
    double squared_error = 0;  ///< of the 512 values by Parseval's theorem, but for the mean's own
  };
  /// At a step number. The bits are what encode() takes, to a fraction of a bit.
  Cost cost(std::int32_t step);

  /// Writes the stream to all of `out`. Where that is shorter than the stream, the smallest coefficients
  /// go until it fits, where longer it has zeros in its middle. `constants` has what the file has.
  void encode(const BlockConstants& constants, const MeanRange& range, std::int32_t step, std::span<std::byte> out);
  /// Whether some went in the last encode().
  bool dropped() const { return dropped_; }
  /// The values that the stream of the last encode(), of those arguments, decodes to: decode_block()'s bits, without
  /// decoding it. False where it is a mean alone.
  bool decoded(const BlockConstants& constants, const MeanRange& range, std::int32_t step,
               std::span<float, 512> values) const;

 private:
  ValueEncoder coder_;
  RowCosts rows_;
  float mean_ = 0;
  double largest_ = 0;
  double energy_ = 0;
  std::array<float, 512> coefficients_{};  // by index; that of the mean is 0
  std::array<float, 64> row_largest_{};
  std::array<double, 64> row_energy_{};
  MagnitudeRows magnitudes_;
  StreamFront front_;  // of the last encode()
  bool dropped_ = false;
};

}  // namespace weir
