#include "compressor/packed/packed_rule.h"

#include <algorithm>
#include <cmath>

#include "format/packed/block_steps.h"

namespace weir {

std::int32_t coarsest_step(float min, float max) {
  const double range = static_cast<double>(max) - static_cast<double>(min);
  if (!(range > 0)) return 0;
  // A coefficient is at most range / 2 * sqrt(512), and counts from 0.6 steps on; a ladder begins two octaves above.
  constexpr double kLargestStep = 11.4 / 0.6 * 4;
  const int exponent = std::ilogb(range * kLargestStep) + 1;
  return std::clamp(-2 * exponent, kLeastStep, kMostStep);
}

}  // namespace weir
