// Mixes 64 bits, for repeatable pseudo-random numbers without a state. For host and device.
#pragma once

#include <cstdint>

#include "format/base/host_device.h"

namespace weir {

/// The finaliser of SplitMix64 (Steele, Lea, Flood, "Fast splittable pseudorandom number generators", OOPSLA 2014): a
/// bijection with full avalanche.
WEIR_HOST_DEVICE constexpr std::uint64_t mix_bits(std::uint64_t v) {
  v = (v ^ (v >> 30U)) * 0xBF58476D1CE4E5B9ULL;
  v = (v ^ (v >> 27U)) * 0x94D049BB133111EBULL;
  return v ^ (v >> 31U);
}

/// The increment of SplitMix64: mix_bits(v + kGoldenGamma) is its number after the state v.
inline constexpr std::uint64_t kGoldenGamma = 0x9E3779B97F4A7C15ULL;

}  // namespace weir
