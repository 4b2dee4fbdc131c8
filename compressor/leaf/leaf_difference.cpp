#include "compressor/leaf/leaf_difference.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "compressor/leaf/inside_voxels.h"
#include "format/base/doubles8.h"

namespace weir {
namespace {

constexpr std::size_t kLanes = 8;
constexpr std::size_t kHalves = 2;  // 16 sums, in two halves of eight lanes

struct DifferenceLanes {
  Doubles8 squared_error{};
  Doubles8 max_abs{};
  Floats8 min{};
  Floats8 max{};
  Ints8 nonfinite{};
  Ints8 nonfinite_decoded{};
  Ints8 different{};
  Ints8 nonfinite_different{};
  Ints8 zeros_lost{};
};

// Adds the differences of one leaf to `halves`. With AllFinite, all values must be finite.
template <bool AllFinite>
[[gnu::always_inline]] inline void accumulate_values(const float* source, const float* decoded,
                                                     DifferenceLanes* halves) {
  const Floats8 none{};
  for (std::size_t half = 0; half < kHalves; ++half) {
    DifferenceLanes lanes = halves[half];
    for (std::size_t i = half * kLanes; i < kLeafVoxels; i += kHalves * kLanes) {
      Floats8 s;
      Floats8 d;
      Ints8 s_bits;
      Ints8 d_bits;
      std::memcpy(&s, source + i, sizeof s);
      std::memcpy(&d, decoded + i, sizeof d);
      std::memcpy(&s_bits, source + i, sizeof s_bits);
      std::memcpy(&d_bits, decoded + i, sizeof d_bits);
      Floats8 s_counted = s;
      Floats8 d_counted = d;
      Ints8 s_finite = ~Ints8{};
      const Ints8 differs = s_bits != d_bits;
      if constexpr (!AllFinite) {
        // v - v is 0 for a finite v and NaN otherwise. All bits of a lane are set if the comparison holds.
        s_finite = s - s == none;
        const Ints8 d_finite = d - d == none;
        const Ints8 both = s_finite & d_finite;
        s_counted = both ? s : none;
        d_counted = both ? d : none;
        lanes.nonfinite -= ~s_finite;
        lanes.nonfinite_decoded -= s_finite & ~d_finite;
        lanes.nonfinite_different -= differs & ~s_finite;
      }
      const Doubles8 difference = Doubles8(s_counted) - Doubles8(d_counted);
      const Doubles8 magnitude = select(difference < 0.0, -difference, difference);
      lanes.squared_error += difference * difference;
      lanes.max_abs = select(magnitude > lanes.max_abs, magnitude, lanes.max_abs);
      lanes.min = s < lanes.min && s_finite ? s : lanes.min;
      lanes.max = s > lanes.max && s_finite ? s : lanes.max;
      lanes.different -= differs & s_finite;
      lanes.zeros_lost -= (s == none) & (d != none);
    }
    halves[half] = lanes;
  }
}

WEIR_SIMD void accumulate(const float* source, const float* decoded, DifferenceLanes* halves) {
  accumulate_values<false>(source, decoded, halves);
}
// The same if all values are finite. Otherwise the squared error becomes non-finite.
WEIR_SIMD void accumulate_finite(const float* source, const float* decoded, DifferenceLanes* halves) {
  accumulate_values<true>(source, decoded, halves);
}

using Halves = std::array<DifferenceLanes, kHalves>;

Halves no_differences() {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  Halves halves;
  for (DifferenceLanes& lanes : halves) {
    lanes.min = lanes.min + kInfinity;
    lanes.max = lanes.max - kInfinity;
  }
  return halves;
}

bool all_finite(const Halves& halves) {
  const Doubles8 sum = halves[0].squared_error + halves[1].squared_error;
  double total = 0;
  for (unsigned l = 0; l < kLanes; ++l) total += sum[l];
  return std::isfinite(total);
}

}  // namespace

LeafDifference difference_of(const LeafValues& source, const LeafValues& decoded) {
  Halves halves = no_differences();
  accumulate_finite(source.data(), decoded.data(), halves.data());
  if (!all_finite(halves)) {
    halves = no_differences();
    accumulate(source.data(), decoded.data(), halves.data());
  }

  const Doubles8 sums = halves[0].squared_error + halves[1].squared_error;
  std::array<double, kLanes> squared_error;
  std::memcpy(squared_error.data(), &sums, sizeof sums);
  for (unsigned half = kLanes / 2; half > 0; half /= 2) {
    for (unsigned l = 0; l < half; ++l) squared_error[l] += squared_error[l + half];
  }
  LeafDifference result;
  result.squared_error = squared_error[0];
  result.range = {halves[0].min[0], halves[0].max[0]};
  for (const DifferenceLanes& lanes : halves) {
    for (unsigned l = 0; l < kLanes; ++l) {
      result.max_abs = std::max(result.max_abs, lanes.max_abs[l]);
      result.range.min = std::min(result.range.min, lanes.min[l]);
      result.range.max = std::max(result.range.max, lanes.max[l]);
      result.nonfinite += static_cast<std::uint32_t>(lanes.nonfinite[l]);
      result.nonfinite_decoded += static_cast<std::uint32_t>(lanes.nonfinite_decoded[l]);
      result.different += static_cast<std::uint32_t>(lanes.different[l]);
      result.nonfinite_different += static_cast<std::uint32_t>(lanes.nonfinite_different[l]);
      result.zeros_lost += static_cast<std::uint32_t>(lanes.zeros_lost[l]);
    }
  }
  return result;
}

LeafValues inside_only(const LeafValues& values, const LeafValues& outside, const Box& node, const Box& inside) {
  LeafValues all = outside;
  for_each_inside(node, inside, [&](std::size_t i) { all[i] = values[i]; });
  return all;
}

double abs_difference(float source, float decoded) {
  if (!std::isfinite(source) || !std::isfinite(decoded)) return 0.0;
  return std::abs(static_cast<double>(source) - static_cast<double>(decoded));
}

}  // namespace weir
