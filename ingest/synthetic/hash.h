// Integer hashing for repeatable randomness. It has no state, so voxels can be computed in any order.
#pragma once

#include <cstdint>

#include "format/base/mix_bits.h"

namespace weir {

/// Returns the hash of a lattice position. Odd multipliers keep the axes apart before the mixing.
constexpr std::uint64_t hash_position(std::uint64_t key, std::int64_t x, std::int64_t y, std::int64_t z) {
  return mix_bits(key + static_cast<std::uint64_t>(x) * kGoldenGamma +
                  static_cast<std::uint64_t>(y) * 0xc2b2ae3d27d4eb4fULL +
                  static_cast<std::uint64_t>(z) * 0x165667b19e3779f9ULL);
}

/// Returns a key for the `stream`-th independent use of a seed.
constexpr std::uint64_t derive_key(std::uint64_t seed, std::uint64_t stream) {
  return mix_bits(mix_bits(seed + kGoldenGamma) + stream);
}

/// Returns the upper 24 bits as a multiple of 2^-24 in [0, 1). Every value is exact.
constexpr float unit_float(std::uint64_t bits) { return static_cast<float>(bits >> 40U) * 0x1p-24F; }

}  // namespace weir
