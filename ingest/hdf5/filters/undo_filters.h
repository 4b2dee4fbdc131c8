// The filters besides deflate and shuffle that weir undoes itself: lzf and Fletcher's checksum. Both use memory of a
// known size.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace weir {

/// Decodes the lzf data `stream` into all of `bytes` and never writes beyond them. A control byte n below 32 is
/// followed by n + 1 literals. Any other control byte, with the next, says how many bytes to repeat and from how far
/// back (M. Lehmann, LibLZF, lzf_d.c). Throws Error(input), without a place, if the stream is damaged, ends early or
/// holds more.
void unpack_lzf(std::span<const std::byte> stream, std::span<std::byte> bytes);

inline constexpr std::size_t kFletcher32Bytes = 4;

/// Returns Fletcher's checksum over big-endian 16-bit words; the last word is padded with a zero byte. Both sums are
/// in ones' complement, the second in the upper half (J. Fletcher, "An Arithmetic Checksum for Serial Transmissions",
/// 1982).
std::uint32_t fletcher32(std::span<const std::byte> bytes);

/// Returns the bytes before the checksum at the end of `bytes`. Throws Error(input), without a place, if there are
/// fewer bytes than the checksum takes, or if the checksum does not match.
std::span<std::byte> check_fletcher32(std::span<std::byte> bytes);

}  // namespace weir
