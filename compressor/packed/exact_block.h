// Writes a block's exact stream, or the exact stream of its values rounded to within an error. The survey, which counts
// the bytes, and the encode pass, which writes them, get the same bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "format/leaf/leaf_codec.h"
#include "format/packed/block_encode.h"
#include "format/packed/lattice_block.h"
#include "format/packed/value_encoder.h"

namespace weir {

/// The file's lattice if the source's type implies none: whole numbers except -0 and numbers of magnitude 2^23 or more.
/// Floats are often such numbers.
inline constexpr Lattice kWholeNumbers{-0x1p23F, 1.0F, kMostLatticeBits};

/// Use one object per thread.
class ExactBlock {
 public:
  /// Writes the shortest stream that gives every bit of `block` back, and returns its bytes. `lattice` is the lattice
  /// on which all values lie by the source's type.
  std::uint32_t write(const LeafValues& block, const std::optional<Lattice>& lattice, std::span<std::byte> out,
                      FloatOrder order = FloatOrder::used) const;

  /// Does the same for finite values, each rounded to within `max_error` of itself. Returns 0 if no lattice of 24 bits
  /// is fine enough.
  std::uint32_t write_bounded(const LeafValues& block, double max_error, std::span<std::byte> out) const;

 private:
  ValueEncoder coder_{built_in_tables(), ValueEncoder::Kind::lattice};
};

}  // namespace weir
