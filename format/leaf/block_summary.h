// The results of the survey for one 8^3 block, from the values before encoding. For host and device.
#pragma once

#include <cstdint>

#include "format/base/host_device.h"
#include "format/base/mix_bits.h"
#include "format/io/digest.h"

namespace weir {

struct BlockSummary {
  float min = 0;  ///< of the finite in-domain values; 0 if there are none
  float max = 0;
  float mean = 0;            ///< of the finite values, rounded to float; if uniform, the value itself
  float sample = 0;          ///< one in-domain value, chosen by a hash of the leaf index; NaN if that one is not finite
  float residual = 0;        ///< sum of (value - mean) over the finite values
  std::uint16_t finite = 0;  ///< finite in-domain values, 0..512
  std::uint16_t same_bits : 1 = 0;  ///< see uniform()
  std::uint16_t zeros : 15 = 0;     ///< finite in-domain values equal to 0
  double sse = 0;                   ///< sum of (value - mean)^2 over the finite values
  Digest digest;                    ///< of the in-domain float32 values, x fastest

  /// Returns whether there are finite values and all have the same bits: those of `mean`.
  bool uniform() const { return same_bits != 0; }
};
static_assert(sizeof(BlockSummary) == 48);

/// Returns the position in [0, count) of the sampled voxel of leaf `index`. A hash (SplitMix64, its high bits scaled to
/// the range) chooses it, so that a regular pattern in the data cannot avoid the samples.
WEIR_HOST_DEVICE inline std::size_t sample_position(std::int64_t index, std::size_t count) {
  const std::uint64_t h = mix_bits(static_cast<std::uint64_t>(index) + kGoldenGamma);
  return static_cast<std::size_t>((h >> 32U) * count >> 32U);
}

}  // namespace weir
