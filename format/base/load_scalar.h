// Reads numbers from the bytes of a file, in either byte order.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "format/base/scalar_type.h"

namespace weir {

constexpr std::uint8_t with_bytes_swapped(std::uint8_t bits) { return bits; }
constexpr std::uint16_t with_bytes_swapped(std::uint16_t bits) { return __builtin_bswap16(bits); }
constexpr std::uint32_t with_bytes_swapped(std::uint32_t bits) { return __builtin_bswap32(bits); }
constexpr std::uint64_t with_bytes_swapped(std::uint64_t bits) { return __builtin_bswap64(bits); }

/// Returns the T in the sizeof(T) bytes from `bytes` on; needs no alignment.
template <typename T>
T load_scalar(const std::byte* bytes, bool big_endian) {
  static_assert(std::is_arithmetic_v<T> && sizeof(T) <= sizeof(std::uint64_t));
  using Bits = std::conditional_t<sizeof(T) == 1, std::uint8_t,
                                  std::conditional_t<sizeof(T) == 2, std::uint16_t,
                                                     std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint64_t>>>;
  Bits bits;
  std::memcpy(&bits, bytes, sizeof bits);
  return std::bit_cast<T>(big_endian == kNativeIsBig ? bits : with_bytes_swapped(bits));
}

}  // namespace weir
