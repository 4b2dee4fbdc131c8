// Near rungs of a block's ladder: values rounded to multiples of a power of two, on a lattice of the block's own. For
// host and device.
#pragma once

#include <cstdint>

#include "format/base/host_device.h"

namespace weir {

/// Which blocks have near rungs, besides the sampled ones.
enum class NearBlocks : std::uint8_t {
  none,
  sparse,  ///< blocks with mostly zero values, which near rungs suit at any budget
  all      ///< all blocks, if nearly everything is kept
};

/// Number of near rungs, from coarse to fine; each quantum is half of the one before.
inline constexpr std::int32_t kNearRungs = 12;

/// Values below 2^23 quanta are rounded exactly, so no quantum is finer than that.
inline constexpr std::int32_t kMostRoundedBits = 23;
/// The predictor of all rungs is the one that is best when values have this many bits.
inline constexpr std::int32_t kUsualRoundedBits = 18;
/// Bounds of the quanta's exponents: the quanta are normal numbers, and the lattice's end is finite.
inline constexpr std::int32_t kLeastQuantumExponent = -125;
inline constexpr std::int32_t kMostQuantumExponent = 127 - 26;

/// The magnitudes of coded residuals are below this.
inline constexpr std::uint32_t kMostRoundedResidual = 1U << 23U;
/// The bytes at the beginning of a stream (its kind, minimum and quantum), and the bits of its first code.
inline constexpr std::uint32_t kRoundedFrontBytes = 9;
inline constexpr unsigned kRoundedNumberBits = 24;

/// Returns the least exponent with `largest` < 2^exponent, for the largest |value| of a block; the least exponent of
/// quanta if `largest` is 0.
WEIR_HOST_DEVICE inline std::int32_t rounded_exponent(float largest) {
  if (!(largest > 0)) return kLeastQuantumExponent;
  std::uint32_t bits;
  __builtin_memcpy(&bits, &largest, sizeof bits);
  const std::uint32_t exponent = bits >> 23U;
  if (exponent > 0) return static_cast<std::int32_t>(exponent) - 126;
  return 32 - __builtin_clz(bits) - 149;
}

/// Returns the exponent of the coarsest near rung's quantum.
WEIR_HOST_DEVICE inline std::int32_t coarsest_near_exponent(std::int32_t exponent) {
  return exponent - kMostRoundedBits + kNearRungs - 1;
}

/// Returns the near rung at which a search around a quantum of exponent `wanted` begins.
WEIR_HOST_DEVICE inline std::int32_t near_rung_about(std::int32_t coarsest, std::int32_t wanted) {
  const std::int32_t rung = coarsest - wanted;
  return rung < 0 ? 0 : rung < kNearRungs ? rung : kNearRungs - 1;
}

/// Returns whether a block of the exponent `exponent` can have a quantum of the exponent `quantum`.
WEIR_HOST_DEVICE inline bool is_quantum_exponent(std::int32_t quantum, std::int32_t exponent) {
  return quantum >= kLeastQuantumExponent && quantum >= exponent - kMostRoundedBits && quantum <= kMostQuantumExponent;
}

}  // namespace weir
