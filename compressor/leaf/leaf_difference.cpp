#include "compressor/leaf/leaf_difference.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "format/base/simd.h"

namespace weir {
namespace {

constexpr std::size_t kDifferenceLanes = 16;

struct DifferenceLanes {
  std::array<double, kDifferenceLanes> squared_error;
  std::array<double, kDifferenceLanes> max_abs;
  std::array<float, kDifferenceLanes> min;
  std::array<float, kDifferenceLanes> max;
  std::array<std::uint32_t, kDifferenceLanes> nonfinite;
  std::array<std::uint32_t, kDifferenceLanes> nonfinite_decoded;
  std::array<std::uint32_t, kDifferenceLanes> different;
  std::array<std::uint32_t, kDifferenceLanes> nonfinite_different;
};

// v - v is 0 for a finite v and NaN for every other.
inline bool is_finite(float v) { return v - v == 0.0F; }

WEIR_SIMD void accumulate(const float* source, const float* decoded, DifferenceLanes& lanes) {
  for (std::size_t i = 0; i < kLeafVoxels; i += kDifferenceLanes) {
    for (std::size_t l = 0; l < kDifferenceLanes; ++l) {
      const float s = source[i + l];
      const float d = decoded[i + l];
      const bool s_finite = is_finite(s);
      const bool d_finite = is_finite(d);
      const double difference = static_cast<double>(s) - static_cast<double>(d);
      const double counted = s_finite && d_finite ? difference : 0.0;
      const double magnitude = counted < 0.0 ? -counted : counted;
      lanes.squared_error[l] += counted * counted;
      lanes.max_abs[l] = magnitude > lanes.max_abs[l] ? magnitude : lanes.max_abs[l];
      lanes.min[l] = s_finite && s < lanes.min[l] ? s : lanes.min[l];
      lanes.max[l] = s_finite && s > lanes.max[l] ? s : lanes.max[l];
      lanes.nonfinite[l] += s_finite ? 0U : 1U;
      lanes.nonfinite_decoded[l] += s_finite && !d_finite ? 1U : 0U;
      const bool differs = std::bit_cast<std::uint32_t>(s) != std::bit_cast<std::uint32_t>(d);
      lanes.different[l] += differs && s_finite ? 1U : 0U;
      lanes.nonfinite_different[l] += differs && !s_finite ? 1U : 0U;
    }
  }
}

}  // namespace

LeafDifference difference_of(const LeafValues& source, const LeafValues& decoded) {
  DifferenceLanes lanes{};
  lanes.min.fill(std::numeric_limits<float>::infinity());
  lanes.max.fill(-std::numeric_limits<float>::infinity());
  accumulate(source.data(), decoded.data(), lanes);

  for (std::size_t half = kDifferenceLanes / 2; half > 0; half /= 2) {
    for (std::size_t l = 0; l < half; ++l) lanes.squared_error[l] += lanes.squared_error[l + half];
  }
  LeafDifference result;
  result.squared_error = lanes.squared_error[0];
  result.range = {lanes.min[0], lanes.max[0]};
  for (std::size_t l = 0; l < kDifferenceLanes; ++l) {
    result.max_abs = std::max(result.max_abs, lanes.max_abs[l]);
    result.range.min = std::min(result.range.min, lanes.min[l]);
    result.range.max = std::max(result.range.max, lanes.max[l]);
    result.nonfinite += lanes.nonfinite[l];
    result.nonfinite_decoded += lanes.nonfinite_decoded[l];
    result.different += lanes.different[l];
    result.nonfinite_different += lanes.nonfinite_different[l];
  }
  return result;
}

double abs_difference(float source, float decoded) {
  if (!is_finite(source) || !is_finite(decoded)) return 0.0;
  return std::abs(static_cast<double>(source) - static_cast<double>(decoded));
}

}  // namespace weir
