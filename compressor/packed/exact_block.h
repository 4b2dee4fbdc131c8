// A block's exact stream, and one that is exact of values rounded to within an error: the same bytes in the survey,
// which counts them, and in the encode pass, which writes them.
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

/// The file's lattice where the source's type says of none: whole numbers that are neither -0 nor 2^23 or more away
/// from 0. Floats often are such numbers.
inline constexpr Lattice kWholeNumbers{-0x1p23F, 1.0F, kMostLatticeBits};

/// One per thread.
class ExactBlock {
 public:
  /// Writes the shortest stream that gives every bit of `block` back; `lattice` is what the source's type says that all
  /// values lie on. Returns its bytes.
  std::uint32_t write(const LeafValues& block, const std::optional<Lattice>& lattice, std::span<std::byte> out,
                      FloatOrder order = FloatOrder::used) const;

  /// The same for finite values rounded so that each is within `max_error` of its own. 0 where no lattice of 24 bits
  /// does that.
  std::uint32_t write_bounded(const LeafValues& block, double max_error, std::span<std::byte> out) const;

 private:
  ValueEncoder coder_{built_in_tables(), ValueEncoder::Kind::lattice};
};

}  // namespace weir
