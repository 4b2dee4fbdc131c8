// The checksum that Zarr's codec crc32c appends to bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace weir {

inline constexpr std::size_t kCrc32cBytes = 4;

/// Returns Castagnoli's 32-bit CRC, reflected, with all bits set at the start and inverted at the end (RFC 3720,
/// section 12.1).
std::uint32_t crc32c(std::span<const std::byte> bytes);

/// Returns `bytes` without the checksum at their end, which is stored lowest byte first. Throws Error(input), with no
/// place in its message, if `bytes` are too short for a checksum or do not match it.
std::span<std::byte> check_crc32c(std::span<std::byte> bytes);

}  // namespace weir
