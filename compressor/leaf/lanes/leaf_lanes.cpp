#include "compressor/leaf/lanes/leaf_lanes.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "compressor/leaf/lanes/lane_estimates.h"
#include "compressor/leaf/lanes/lane_summary.h"
#include "compressor/leaf/leaf_lattice.h"
#include "compressor/leaf/leaf_summary.h"
#include "compressor/leaf/quantiser_fit.h"
#include "ingest/plan/block_parts.h"

namespace weir {
namespace {

using LaneValues = std::array<Floats8, kMostLaneValues>;

// Returns whether the results of the lanes are valid for the row.
bool suits_lanes(const LeafRow& row) {
  const double width = static_cast<double>(row.max) - static_cast<double>(row.min);
  return width >= static_cast<double>(kLeastLaneWidth) && std::fabs(row.min) <= kMostLaneMagnitude &&
         std::fabs(row.max) <= kMostLaneMagnitude;
}

void set_summary(const LaneSummary& summary, int lane, LeafRow& row) {
  row.min = summary.ranges.min[lane];
  row.max = summary.ranges.max[lane];
  row.mean = summary.ranges.mean[lane];
  row.residual = summary.ranges.residual[lane];
  row.sse = summary.sse[lane];
  row.finite = static_cast<std::uint16_t>(kLeafVoxels);
  row.zeros = static_cast<std::uint32_t>(summary.zeros[lane]) & 0x7FFFU;
}

// Does what summarize_widths() does, from what was found for the lane.
void set_widths(std::span<const float> distinct, std::uint16_t at_ends, const std::array<Doubles8, 3>& squared_errors,
                int lane, LeafRow& row) {
  if (const auto lattice = find_lattice(distinct, row.min, row.max)) {
    row.exact_bits = static_cast<std::uint8_t>(bits_for(lattice->largest));
  }
  if (row.exact_bits == 0 || row.exact_bits > 8) row.at_ends = at_ends;
  const unsigned exact_bits = row.exact_bits == 0 ? 32 : row.exact_bits;
  for (unsigned log2 = 0; log2 < row.quantised.size(); ++log2) {
    const double squares = squared_errors[log2][lane];
    if (1U << log2 >= exact_bits) {
      row.quantised[log2] = 0;
    } else if (row.sse > 0 && std::isfinite(squares)) {
      row.quantised[log2] = static_cast<float>(std::min(1.0, kEstimateStarts[log2].gain * squares / row.sse));
    }
  }
}

void set_widths_alone(std::span<const float> distinct, const Index3& by, LeafRow& row) {
  std::array<float, kLeafVoxels> values;
  repeat_values(distinct.data(), by, {kLeafDim, kLeafDim, kLeafDim}, values.data());
  summarize_widths(values, distinct, LeafRepeats::in_source_order(by), row);
}

}  // namespace

bool LeafLanes::takes(std::span<const float> distinct) {
  const auto bits_of = [](float v) { return std::bit_cast<std::uint32_t>(v); };
  const std::uint32_t first = bits_of(distinct.front());
  std::uint32_t differ = 0;
  std::uint32_t others = 0;
  for (const float v : distinct) {
    differ |= bits_of(v) ^ first;
    others |= (bits_of(v) & 0x7F800000U) == 0x7F800000U ? 1U : 0U;
  }
  return differ != 0 && others == 0;
}

void LeafLanes::begin(const Index3& by) {
  by_ = by;
  shape_ = LaneShape::of(by);
  size_ = 0;
}

void LeafLanes::add(std::span<const float> distinct) {
  std::copy(distinct.begin(), distinct.end(), rows_[size_++].begin());
}

void LeafLanes::summarize(bool widths, std::span<LeafRow> rows) {
  if (size_ == 0) return;
  LaneValues values;
  for (std::size_t i = 0; i < shape_.values(); ++i) {
    for (std::size_t l = 0; l < kLeafLanes; ++l) values[i][static_cast<int>(l)] = rows_[l < size_ ? l : 0][i];
  }
  LaneSummary summary;
  summarize_lanes(values.data(), shape_, summary);
  std::array<Doubles8, 3> squared_errors;
  if (widths) estimate_lanes(values.data(), shape_, summary.ranges, squared_errors);
  for (std::size_t i = 0; i < size_; ++i) {
    const int lane = static_cast<int>(i);
    LeafRow& row = rows[i];
    set_summary(summary, lane, row);
    if (!widths) continue;
    if (suits_lanes(row)) {
      set_widths(distinct(i), static_cast<std::uint16_t>(summary.at_ends[lane]), squared_errors, lane, row);
    } else {
      set_widths_alone(distinct(i), by_, row);
    }
  }
}

}  // namespace weir
