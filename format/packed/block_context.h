// Computes the context of a coefficient of a packed block from the magnitudes around it (FORMAT.md, "Coded values").
// For host and device.
#pragma once

#include <cstdint>

#include "format/base/host_device.h"
#include "format/packed/block_constants.h"

namespace weir {

/// Larger magnitudes count as this one in a sum of neighbours.
inline constexpr std::uint32_t kMostOfNeighbour = 1U << 20U;
/// The number of sums of neighbours (six times their mean) that have an entry; larger sums have the last level.
inline constexpr std::uint32_t kLevelSums = 321;

namespace packed_detail {

// Level of the sum t: floor(3 log2(1 + 4 t / 6)), at most 23. In whole numbers: the largest n with 2^n <= (1 + 2 t /
// 3)^3.
constexpr void make_levels(std::uint8_t (&levels)[kLevelSums]) {
  for (std::uint64_t t = 0; t < kLevelSums; ++t) {
    const std::uint64_t cube = (3 + 2 * t) * (3 + 2 * t) * (3 + 2 * t);
    std::uint8_t level = 0;
    while (level < kPackedLevels - 1 && (std::uint64_t{27} << (level + 1U)) <= cube) ++level;
    levels[t] = level;
  }
}

}  // namespace packed_detail

/// Returns how many low bits of a magnitude are stored uncoded. `t` is the weighted sum of its neighbours.
WEIR_HOST_DEVICE inline unsigned extra_bits(std::uint32_t t) {
  if (t <= 36) return 0;
  const unsigned bits = 31U - static_cast<unsigned>(__builtin_clz(t / 18));
  return bits < 16 ? bits : 16;
}

}  // namespace weir
