// Computes the length of the stream of coded values from the costs of its parts. For host and device.
#pragma once

#include <cstddef>
#include <cstdint>

#include "format/base/host_device.h"
#include "format/packed/coefficient_decoder.h"

namespace weir {

/// Bytes of a stream of raw values. No exact stream is longer.
inline constexpr std::uint32_t kRawStreamBytes = 1 + 4 * 512;
/// Room to write any stream. The longest takes 2 bytes more than raw values: a stream of coefficients is chosen if,
/// counted without the code of its mean, it is shorter than raw values. That code has up to 24 bits.
inline constexpr std::size_t kStreamRoom = 4096;
/// Bytes of the stream of a block with one value in all voxels: its kind and the value.
inline constexpr std::uint32_t kOneValueStreamBytes = 1 + 4;
/// Bits of the stream of a mean alone, without the mean's code: its kind and its step.
inline constexpr std::uint32_t kMeanAloneBits = 8;

/// Bits of the `end` field of a lattice stream, and of the first code of floats in order.
inline constexpr unsigned kLatticeEndBits = 6;
inline constexpr unsigned kOrderedNumberBits = 32;

/// Returns the bits of a stream's front and of the rest behind it. `symbols` is the cost of symbols in 1/256 bits,
/// `raw` the uncoded bits, `nonzero` the number of signs. `end` > 0 is written in `end_bits`, beside a number of
/// `number_bits`.
WEIR_HOST_DEVICE inline std::uint32_t coded_stream_bits(std::uint32_t symbols, std::uint32_t raw, std::uint32_t nonzero,
                                                        unsigned end, unsigned end_bits, unsigned number_bits) {
  const unsigned states = states_of(end);
  // Each state begins with 16 to 17 bits, 16 of which hold signs and low bits of the number, and ends in whole bytes,
  // at least 3. Rounding to whole numbers in a state loses a little of each symbol.
  std::uint32_t coded = symbols + 256 * (raw + 17 * states);
  coded += coded / 1024;
  const std::uint32_t words = (coded + 2047) / 2048 + (states - 1);
  const std::uint32_t back = words < 3 * states ? 3 * states : words;
  std::int32_t spare = static_cast<std::int32_t>(nonzero) - static_cast<std::int32_t>(16 * states);
  const std::int32_t least = -static_cast<std::int32_t>(number_bits);
  spare = spare < least ? least : spare;
  const std::int32_t front = static_cast<std::int32_t>(end_bits + states) + spare;
  return static_cast<std::uint32_t>(front + static_cast<std::int32_t>(8 * back));
}

}  // namespace weir
