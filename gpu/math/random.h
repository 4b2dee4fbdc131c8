// Random numbers of one sample of one pixel. The sequence depends only on (seed, pixel, sample), so an image does not
// depend on threads, tiles or back end.
#pragma once

#include "format/base/mix_bits.h"
#include "gpu/math/portable.h"

namespace weir {

/// PCG32 (O'Neill 2014, XSH-RR output of a 64-bit congruential generator), seeded by hashing.
class Random {
 public:
  WEIR_HOST_DEVICE Random(std::uint64_t seed, std::uint64_t pixel, std::uint64_t sample)
      : state_(scramble(scramble(scramble(seed) ^ pixel) ^ sample)),
        increment_(scramble(pixel + 0x632be59bd9b4e019ULL * (sample + 1)) | 1U) {}

  WEIR_HOST_DEVICE std::uint32_t bits() {
    const std::uint64_t old = state_;
    state_ = old * 6364136223846793005ULL + increment_;
    const auto xorshifted = static_cast<std::uint32_t>(((old >> 18U) ^ old) >> 27U);
    const auto rotation = static_cast<std::uint32_t>(old >> 59U);
    return (xorshifted >> rotation) | (xorshifted << ((32U - rotation) & 31U));
  }

  /// Returns a uniform number in [0, 1): a multiple of 2^-24 that may be 0 and is never 1.
  WEIR_HOST_DEVICE float uniform() { return static_cast<float>(bits() >> 8U) * 0x1p-24F; }

 private:
  WEIR_HOST_DEVICE static constexpr std::uint64_t scramble(std::uint64_t x) { return mix_bits(x + kGoldenGamma); }

  std::uint64_t state_;
  std::uint64_t increment_;
};

/// Returns the optical depth to the next tentative collision, exponentially distributed. It is finite for u in [0,
/// 1).
WEIR_HOST_DEVICE inline float free_depth(float u) { return -std::log(1.0F - u); }

}  // namespace weir
