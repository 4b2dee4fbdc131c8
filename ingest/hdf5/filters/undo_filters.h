// The filters that weir undoes itself besides deflate and shuffle: lzf and Fletcher's checksum, each in memory of known
// size.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace weir {

/// Decodes `stream` into all of `bytes`, and never writes beyond them. A byte below 32 is followed by one literal
/// more than it says; any other one, with the next, tells how many bytes to repeat from how far back (M. Lehmann,
/// LibLZF, lzf_d.c). Throws Error(input), without a place, where the stream is damaged, ends early or holds more.
void unpack_lzf(std::span<const std::byte> stream, std::span<std::byte> bytes);

inline constexpr std::size_t kFletcher32Bytes = 4;

/// Fletcher's checksum over big-endian 16-bit words, the last one padded with a zero byte: both sums in
/// ones' complement, the second one in the upper half (J. Fletcher, "An Arithmetic Checksum for Serial
/// Transmissions", 1982).
std::uint32_t fletcher32(std::span<const std::byte> bytes);

/// The bytes before the checksum at the end of `bytes`. Throws Error(input), without a place, where they
/// are fewer than the checksum takes or do not match it.
std::span<std::byte> check_fletcher32(std::span<std::byte> bytes);

}  // namespace weir
