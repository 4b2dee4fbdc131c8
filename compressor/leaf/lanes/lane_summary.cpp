#include "compressor/leaf/lanes/lane_summary.h"

#include <array>

#include "compressor/leaf/lanes/lane_sums.h"

namespace weir {
namespace {

// Finds the least and the largest value. Of -0.0 and 0.0 it takes the first that it meets, in this order: the first
// value of every row, then the second value of every row, and so on.
[[gnu::always_inline]] inline void find_range(const Floats8* values, const LaneShape& shape, Floats8& min,
                                              Floats8& max) {
  const std::size_t count = shape.values();
  for (std::size_t x = 0; x < shape.x; ++x) {
    Floats8 low = values[0];
    Floats8 high = values[0];
    for (std::size_t i = x; i < count; i += shape.x) {
      low = values[i] < low ? values[i] : low;
      high = values[i] > high ? values[i] : high;
    }
    if (x == 0) {
      min = low;
      max = high;
    }
    min = low < min ? low : min;
    max = high > max ? high : max;
  }
}

}  // namespace

WEIR_SIMD void summarize_lanes(const Floats8* values, const LaneShape& shape, LaneSummary& summary) {
  const std::size_t count = shape.values();
  constexpr auto kVoxels = static_cast<double>(kLeafVoxels);
  std::array<Doubles8, kMostLaneValues> terms;
  terms[0] = Doubles8(values[0]);
  for (std::size_t i = 1; i < count; ++i) terms[i] = Doubles8(values[i]);
  Doubles8 sum;
  sum_groups(terms.data(), shape, sum);
  LaneRanges& ranges = summary.ranges;
  find_range(values, shape, ranges.min, ranges.max);
  narrow(sum / kVoxels, ranges.mean);
  const Doubles8 centre(ranges.mean);
  for (std::size_t i = 0; i < count; ++i) terms[i] -= centre;
  sum_groups(terms.data(), shape, sum);
  narrow(sum, ranges.residual);
  for (std::size_t i = 0; i < count; ++i) terms[i] *= terms[i];
  sum_groups(terms.data(), shape, summary.sse);

  const Floats8 zero{};
  Ints8 zeros{};
  Ints8 at_ends{};
  for (std::size_t i = 0; i < count; ++i) {
    zeros -= values[i] == zero;
    at_ends -= (values[i] == ranges.min) | (values[i] == ranges.max);
  }
  const auto times = static_cast<std::int32_t>(shape.times());
  summary.zeros = zeros * times;
  summary.at_ends = at_ends * times;
}

}  // namespace weir
