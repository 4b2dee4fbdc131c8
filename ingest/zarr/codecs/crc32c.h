// The checksum that Zarr's codec crc32c puts behind bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace weir {

inline constexpr std::size_t kCrc32cBytes = 4;

/// Castagnoli's CRC of 32 bits, reflected, beginning and ended with all bits set (RFC 3720, 12.1).
std::uint32_t crc32c(std::span<const std::byte> bytes);

/// The bytes before the checksum at the end of `bytes`, lowest byte first. Throws Error(input), without a place, where
/// they are fewer than the checksum takes or do not match it.
std::span<std::byte> check_crc32c(std::span<std::byte> bytes);

}  // namespace weir
