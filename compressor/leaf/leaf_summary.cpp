#include "compressor/leaf/leaf_summary.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "compressor/leaf/leaf_lattice.h"
#include "compressor/leaf/leaf_quantiser.h"
#include "format/base/doubles8.h"
#include "format/base/index.h"

namespace weir {
namespace {

// On every machine, sums run in 16 lanes as two vectors of eight: lane l takes values l, l + 16, ...
constexpr std::size_t kSummaryLanes = 16;

struct SummaryLanes {
  Doubles8 low{};
  Doubles8 high{};
};

using LaneArray = std::array<double, kSummaryLanes>;

LaneArray to_array(const SummaryLanes& lanes) {
  LaneArray all;
  std::memcpy(all.data(), &lanes, sizeof lanes);
  return all;
}

// Sums the lanes pairwise, so that the result does not depend on how the lanes were computed.
double sum(LaneArray lanes) {
  for (std::size_t width = kSummaryLanes / 2; width > 0; width /= 2) {
    for (std::size_t i = 0; i < width; ++i) lanes[i] += lanes[i + width];
  }
  return lanes[0];
}

struct Scan {
  std::uint32_t differ;      // bits in which any value differs from the first
  std::uint32_t non_finite;  // number of values that are not finite
  std::uint32_t zeros;
};

WEIR_SIMD Scan scan_bits(const float* values, std::size_t count) {
  std::uint32_t first;
  std::memcpy(&first, values, sizeof first);
  std::uint32_t differ = 0;
  std::uint32_t non_finite = 0;
  std::uint32_t zeros = 0;
  for (std::size_t i = 0; i < count; ++i) {
    std::uint32_t bits;
    std::memcpy(&bits, values + i, sizeof bits);
    differ |= bits ^ first;
    non_finite += (bits & 0x7F800000U) == 0x7F800000U ? 1U : 0U;
    zeros += (bits & 0x7FFFFFFFU) == 0 ? 1U : 0U;
  }
  return {differ, non_finite, zeros};
}

struct Moments {
  float min;
  float max;
  double sum;
};

WEIR_SIMD Moments first_moments(const float* values, std::size_t count) {
  Floats8 low = values[0] - Floats8{};
  Floats8 high = low;
  SummaryLanes total;
  const std::size_t whole = count / kSummaryLanes * kSummaryLanes;
  for (std::size_t i = 0; i < whole; i += kSummaryLanes) {
    Floats8 a;
    Floats8 b;
    std::memcpy(&a, values + i, sizeof a);
    std::memcpy(&b, values + i + kSummaryLanes / 2, sizeof b);
    low = a < low ? a : low;
    low = b < low ? b : low;
    high = a > high ? a : high;
    high = b > high ? b : high;
    total.low += Doubles8(a);
    total.high += Doubles8(b);
  }
  float min = low[0];
  float max = high[0];
  for (int l = 1; l < 8; ++l) {
    min = low[l] < min ? low[l] : min;
    max = high[l] > max ? high[l] : max;
  }
  LaneArray lanes = to_array(total);
  for (std::size_t i = whole; i < count; ++i) {
    min = values[i] < min ? values[i] : min;
    max = values[i] > max ? values[i] : max;
    lanes[i - whole] += static_cast<double>(values[i]);
  }
  return {min, max, sum(lanes)};
}

// Does what first_moments() does, for 512 values in equal pairs of rows. Both halves of the lanes are then the same.
WEIR_SIMD Moments twin_moments(const float* values, std::size_t planes) {
  Floats8 low = values[0] - Floats8{};
  Floats8 high = low;
  SummaryLanes total;
  for (std::size_t z = 0; z < kLeafVoxels; z += planes * kTwinPlane) {
    std::array<Doubles8, kTwins> terms;
    for (std::size_t k = 0; k < kTwins; ++k) {
      Floats8 a;
      std::memcpy(&a, values + z + kTwinStep * k, sizeof a);
      low = a < low ? a : low;
      high = a > high ? a : high;
      terms[k] = Doubles8(a);
    }
    for (std::size_t n = 0; n < planes; ++n) {
      for (std::size_t k = 0; k < kTwins; ++k) total.low += terms[k];
    }
  }
  total.high = total.low;
  float min = low[0];
  float max = high[0];
  for (int l = 1; l < 8; ++l) {
    min = low[l] < min ? low[l] : min;
    max = high[l] > max ? high[l] : max;
  }
  return {min, max, sum(to_array(total))};
}

struct Deviation {
  double sum;
  double squares;
};

WEIR_SIMD Deviation deviations(const float* values, std::size_t count, float mean) {
  const auto centre = static_cast<double>(mean);
  SummaryLanes total;
  SummaryLanes squares;
  const std::size_t whole = count / kSummaryLanes * kSummaryLanes;
  for (std::size_t i = 0; i < whole; i += kSummaryLanes) {
    Floats8 a;
    Floats8 b;
    std::memcpy(&a, values + i, sizeof a);
    std::memcpy(&b, values + i + kSummaryLanes / 2, sizeof b);
    const Doubles8 da = Doubles8(a) - centre;
    const Doubles8 db = Doubles8(b) - centre;
    total.low += da;
    total.high += db;
    squares.low += da * da;
    squares.high += db * db;
  }
  LaneArray total_lanes = to_array(total);
  LaneArray square_lanes = to_array(squares);
  for (std::size_t i = whole; i < count; ++i) {
    const double d = static_cast<double>(values[i]) - centre;
    total_lanes[i - whole] += d;
    square_lanes[i - whole] += d * d;
  }
  return {sum(total_lanes), sum(square_lanes)};
}

// Does what deviations() does, for 512 values in equal pairs of rows.
WEIR_SIMD Deviation twin_deviations(const float* values, std::size_t planes, float mean) {
  const auto centre = static_cast<double>(mean);
  SummaryLanes total;
  SummaryLanes squares;
  for (std::size_t z = 0; z < kLeafVoxels; z += planes * kTwinPlane) {
    std::array<Doubles8, kTwins> terms;
    std::array<Doubles8, kTwins> squared;
    for (std::size_t k = 0; k < kTwins; ++k) {
      Floats8 a;
      std::memcpy(&a, values + z + kTwinStep * k, sizeof a);
      terms[k] = Doubles8(a) - centre;
      squared[k] = terms[k] * terms[k];
    }
    for (std::size_t n = 0; n < planes; ++n) {
      for (std::size_t k = 0; k < kTwins; ++k) {
        total.low += terms[k];
        squares.low += squared[k];
      }
    }
  }
  total.high = total.low;
  squares.high = squares.low;
  return {sum(to_array(total)), sum(to_array(squares))};
}

// Returns the number of values that equal `min` or `max`.
WEIR_SIMD std::uint32_t count_at_ends(const float* values, std::size_t count, float min, float max) {
  std::uint32_t at_ends = 0;
  for (std::size_t i = 0; i < count; ++i) at_ends += (values[i] == min ? 1U : 0U) | (values[i] == max ? 1U : 0U);
  return at_ends;
}

Digest uniform_digest(std::span<const float> values, UniformDigest& last) {
  const auto bits = std::bit_cast<std::uint32_t>(values.front());
  if (last.bits != bits || last.count != values.size()) last = {bits, values.size(), leaf_digest(values)};
  return last.digest;
}

// Sets the statistics of `count` >= 1 finite values. `differ` has the bits in which any value differs from the first.
void summarize_finite(const float* values, std::size_t count, std::uint32_t differ, const LeafRepeats& repeats,
                      LeafRow& row) {
  if (differ == 0) {
    row.min = row.max = row.mean = values[0];
    row.same_bits = 1;
    return;
  }
  const Moments moments =
      repeats.pairs_of_rows() ? twin_moments(values, repeats.groups.slow) : first_moments(values, count);
  row.min = moments.min;
  row.max = moments.max;
  row.mean = static_cast<float>(moments.sum / static_cast<double>(count));
  const Deviation deviation = repeats.pairs_of_rows() ? twin_deviations(values, repeats.groups.slow, row.mean)
                                                      : deviations(values, count, row.mean);
  row.residual = static_cast<float>(deviation.sum);
  row.sse = deviation.squares;
}

}  // namespace

LeafRow summarize_leaf(std::span<const float> values, std::size_t sample_at, UniformDigest& last) {
  return summarize_leaf(values, sample_at, last, values, {});
}

LeafRow summarize_leaf(std::span<const float> values, std::size_t sample_at, UniformDigest& last,
                       std::span<const float> distinct, const LeafRepeats& repeats) {
  const float* data = values.data();
  const std::size_t count = values.size();
  LeafRow row;
  Scan scan = scan_bits(distinct.data(), distinct.size());
  const auto times = static_cast<std::uint32_t>(count / distinct.size());
  scan.non_finite *= times;
  scan.zeros *= times;
  row.digest = scan.differ == 0 ? uniform_digest(values, last) : leaf_digest(values);
  row.finite = static_cast<std::uint16_t>(count - scan.non_finite);
  row.zeros = scan.zeros & 0x7FFFU;
  row.sample = std::isfinite(data[sample_at]) ? data[sample_at] : std::numeric_limits<float>::quiet_NaN();
  if (scan.non_finite == 0) {
    summarize_finite(data, count, scan.differ, repeats, row);
  } else if (row.finite > 0) {
    std::array<float, kLeafVoxels> finite;
    std::size_t kept = 0;
    for (const float v : values) {
      if (std::isfinite(v)) finite[kept++] = v;
    }
    summarize_finite(finite.data(), kept, scan_bits(finite.data(), kept).differ, {}, row);
  }
  return row;
}

ValueRange leaf_range(std::span<const float> values, const LeafRepeats& repeats) {
  const Moments moments = repeats.pairs_of_rows() ? twin_moments(values.data(), repeats.groups.slow)
                                                  : first_moments(values.data(), values.size());
  const auto count = static_cast<double>(values.size());
  const auto mean = static_cast<float>(moments.sum / count);
  return {moments.min, moments.max, mean, moments.sum - count * static_cast<double>(mean)};
}

namespace {

// Does the work of summarize_widths(). `values` are finite; each of `distinct` stands for the same number of values.
void find_widths(std::span<const float> values, bool all, std::span<const float> distinct, const LeafRepeats& repeats,
                 LeafRow& row) {
  if (row.uniform()) row.exact_bits = 1;
  if (!(row.min < row.max)) return;
  const auto lattice = find_lattice(distinct, row.min, row.max);
  if (lattice) row.exact_bits = static_cast<std::uint8_t>(bits_for(lattice->largest));
  if (lattice && !all) {
    row.at_ends = static_cast<std::uint16_t>(lattice->largest);
  } else if (row.exact_bits == 0 || row.exact_bits > 8) {
    const std::size_t times = values.size() / distinct.size();
    row.at_ends = static_cast<std::uint16_t>(times * count_at_ends(distinct.data(), distinct.size(), row.min, row.max));
  }
  const ValueRange range{row.min, row.max, row.mean, static_cast<double>(row.residual)};
  const unsigned exact_bits = row.exact_bits == 0 ? 32 : row.exact_bits;
  if (row.sse > 0) {
    const std::array<double, 3> errors = estimated_errors(values, range, exact_bits, row.sse, repeats);
    for (std::size_t log2 = 0; log2 < errors.size(); ++log2) row.quantised[log2] = static_cast<float>(errors[log2]);
  }
  for (unsigned log2 = 0; log2 < row.quantised.size(); ++log2) {
    if (1U << log2 >= exact_bits) row.quantised[log2] = 0;
  }
}

}  // namespace

void summarize_widths(std::span<const float> values, bool all, LeafRow& row) {
  find_widths(values, all, values, {}, row);
}

void summarize_widths(std::span<const float> values, std::span<const float> distinct, const LeafRepeats& repeats,
                      LeafRow& row) {
  find_widths(values, true, distinct, repeats, row);
}

}  // namespace weir
