// Exact streams of a block: predicted codes of a lattice or of the floats' own order, or the values as they are.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "format/packed/block_constants.h"
#include "format/packed/stream_length.h"
#include "format/packed/value_encoder.h"

namespace weir {

/// Values fl(fl(code * quantum) + minimum).
struct Lattice {
  float minimum = 0;
  float quantum = 0;
  std::uint32_t bits = 0;  ///< of a code, at most kMostLatticeBits
};

/// Whether values on no lattice are predicted as whole numbers in the floats' order; else they are raw.
enum class FloatOrder { used, unused };

/// Writes the shortest stream that gives every bit of 512 values (x << 6 | y << 3 | z) back: on the file's lattice,
/// that of `constants`, or where they do not lie on it on `own`, or on floats in order; or raw, or one value. Returns
/// its bytes, at most kRawStreamBytes; `out` has room for as many. `coder` is of lattice blocks, by the tables of
/// `constants`.
std::uint32_t encode_exact(const ValueEncoder& coder, const BlockConstants& constants,
                           const std::optional<Lattice>& own, std::span<const float, 512> values,
                           std::span<std::byte> out, FloatOrder order = FloatOrder::used);

/// Whether a stream that encode_exact wrote is of floats predicted in their own order.
bool is_ordered(std::span<const std::byte> stream);

/// The values as they are.
std::uint32_t encode_raw(std::span<const float, 512> values, std::span<std::byte> out);

}  // namespace weir
