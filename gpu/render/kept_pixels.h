// What was drawn of a picture before it was cancelled, so that the next call continues it.
#pragma once

#include <cstdint>
#include <numeric>
#include <vector>

#include "gpu/image/image.h"

namespace weir {

struct KeptPixels {
  Image sums;                          ///< sums of the samples' radiance
  std::vector<std::uint32_t> samples;  ///< number of samples of each pixel; empty: nothing was drawn

  /// Returns the number of samples of all pixels.
  std::uint64_t drawn() const { return std::accumulate(samples.begin(), samples.end(), std::uint64_t{0}); }
};

}  // namespace weir
