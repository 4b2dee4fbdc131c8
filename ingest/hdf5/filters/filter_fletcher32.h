// The checksum HDF5 appends to chunks (its filter fletcher32).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace weir {

inline constexpr std::size_t kFletcher32Bytes = 4;

/// Fletcher's checksum over big-endian 16-bit words, the last one padded with a zero byte: both sums in
/// ones' complement, the second one in the upper half (J. Fletcher, "An Arithmetic Checksum for Serial
/// Transmissions", 1982).
std::uint32_t fletcher32(std::span<const std::byte> bytes);

/// The bytes before the checksum at the end of `bytes`. Throws Error(input), without a place, where they
/// are fewer than the checksum takes or do not match it.
std::span<std::byte> check_fletcher32(std::span<std::byte> bytes);

}  // namespace weir
