// Exact streams of a block: predicted codes on a lattice or in the floats' own order, or the raw values.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "format/packed/block_constants.h"
#include "format/packed/stream_length.h"
#include "format/packed/value_encoder.h"

namespace weir {

/// A lattice of the values fl(fl(code * quantum) + minimum).
struct Lattice {
  float minimum = 0;
  float quantum = 0;
  std::uint32_t bits = 0;  ///< bits of a code, at most kMostLatticeBits
};

/// Whether values on no lattice are predicted as whole numbers in the order of floats (used), or stored raw (unused).
enum class FloatOrder { used, unused };

/// Writes the shortest stream that reproduces every bit of 512 values (x << 6 | y << 3 | z). It codes them on the
/// lattice of `constants`, the file's, or if they do not lie on it, on `own`, or otherwise as floats in order; or it
/// stores them raw, or as one value. Returns its bytes, at most kRawStreamBytes; `out` has room for them. `coder` is a
/// coder of lattice blocks with the tables of `constants`.
std::uint32_t encode_exact(const ValueEncoder& coder, const BlockConstants& constants,
                           const std::optional<Lattice>& own, std::span<const float, 512> values,
                           std::span<std::byte> out, FloatOrder order = FloatOrder::used);

/// Returns whether a stream of encode_exact() holds floats predicted in their own order.
bool is_ordered(std::span<const std::byte> stream);

/// Writes the values uncompressed. Returns the bytes of the stream.
std::uint32_t encode_raw(std::span<const float, 512> values, std::span<std::byte> out);

}  // namespace weir
