// What was drawn of a picture before it was given up, so that the next call goes on with it.
#pragma once

#include <cstdint>
#include <numeric>
#include <vector>

#include "gpu/image/image.h"

namespace weir {

struct KeptPixels {
  Image sums;                          ///< of the radiance of the samples
  std::vector<std::uint32_t> samples;  ///< that each pixel has; empty: nothing was drawn

  /// Samples of all pixels.
  std::uint64_t drawn() const { return std::accumulate(samples.begin(), samples.end(), std::uint64_t{0}); }
};

}  // namespace weir
