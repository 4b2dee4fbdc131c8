// Near rungs of a block's ladder: values rounded to multiples of a power of two, on a lattice of the block's own. For
// host and device.
#pragma once

#include <cstdint>

#include "format/base/host_device.h"

namespace weir {

/// Which blocks have near rungs, besides the sampled ones.
enum class NearBlocks : std::uint8_t {
  none,
  sparse,  ///< those most of whose values are zero, which near rungs suit at any budget
  all      ///< where nearly everything is kept
};

/// So many, from coarse to fine; each one's quantum is half of the one before.
inline constexpr std::int32_t kNearRungs = 12;

/// Values below 2^23 quanta are rounded exactly: no quantum is finer.
inline constexpr std::int32_t kMostRoundedBits = 23;
/// The predictor of all rungs is the best one where values have that many bits.
inline constexpr std::int32_t kUsualRoundedBits = 18;
/// Exponents of quanta: these are normal numbers, and the lattice's end is finite.
inline constexpr std::int32_t kLeastQuantumExponent = -125;
inline constexpr std::int32_t kMostQuantumExponent = 127 - 26;

/// Magnitudes of residuals that are coded are below that.
inline constexpr std::uint32_t kMostRoundedResidual = 1U << 23U;
/// A stream begins with its kind, minimum and quantum, which take so many bytes. Its first code takes so many bits.
inline constexpr std::uint32_t kRoundedFrontBytes = 9;
inline constexpr unsigned kRoundedNumberBits = 24;

/// The least exponent with `largest` < 2^exponent, of the largest |value| of a block; the least one of all quanta where
/// that is 0.
WEIR_HOST_DEVICE inline std::int32_t rounded_exponent(float largest) {
  if (!(largest > 0)) return kLeastQuantumExponent;
  std::uint32_t bits;
  __builtin_memcpy(&bits, &largest, sizeof bits);
  const std::uint32_t exponent = bits >> 23U;
  if (exponent > 0) return static_cast<std::int32_t>(exponent) - 126;
  return 32 - __builtin_clz(bits) - 149;
}

/// The exponent of the coarsest near rung's quantum.
WEIR_HOST_DEVICE inline std::int32_t coarsest_near_exponent(std::int32_t exponent) {
  return exponent - kMostRoundedBits + kNearRungs - 1;
}

/// The near rung that a search about a quantum of exponent `wanted` begins at.
WEIR_HOST_DEVICE inline std::int32_t near_rung_about(std::int32_t coarsest, std::int32_t wanted) {
  const std::int32_t rung = coarsest - wanted;
  return rung < 0 ? 0 : rung < kNearRungs ? rung : kNearRungs - 1;
}

/// Whether the quantum may be one of a block of that exponent.
WEIR_HOST_DEVICE inline bool is_quantum_exponent(std::int32_t quantum, std::int32_t exponent) {
  return quantum >= kLeastQuantumExponent && quantum >= exponent - kMostRoundedBits && quantum <= kMostQuantumExponent;
}

}  // namespace weir
