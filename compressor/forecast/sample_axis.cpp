#include "compressor/forecast/sample_axis.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "format/base/index.h"

namespace weir {

SampleAxis::SampleAxis(std::int64_t lo, std::int64_t hi, std::int64_t chunk, std::int64_t chunk_edge,
                       std::int64_t longest, std::int64_t brick)
    : lo_(lo), hi_(hi) {
  const std::int64_t step = brick * kLeafDim;
  const bool chunks_on_leaves = chunk > 0 && chunk_edge % kLeafDim == 0;
  if (chunks_on_leaves) {
    cell_ = std::lcm(chunk, step);
    first_ = chunk_edge + ceil_div(lo - chunk_edge, cell_) * cell_;
    // Bricks lie on multiples of their size. Chunks with another edge do not.
    if (first_ % step != 0) first_ = ceil_div(first_, step) * step;
  } else {
    first_ = ceil_div(lo, step) * step;
    const std::int64_t steps = std::max<std::int64_t>(1, (hi - first_) / step);
    const std::int64_t parts = ceil_div(steps, std::max<std::int64_t>(1, longest / brick));
    cell_ = (chunk > 0 ? ceil_div(chunk, step) : steps / parts) * step;
  }
  cells_ = std::max<std::int64_t>(1, (hi - first_) / cell_);
  taken_ = cells_;
}

bool SampleAxis::narrow() const { return taken_ == 1 || taken_ * cell_ <= kLowerDim; }

void SampleAxis::take_fewer() {
  for (std::int64_t fewer = taken_ - 1; fewer > 0; --fewer) {
    if (fewer * cell_ % kLowerDim != 0) continue;
    taken_ = fewer;
    return;
  }
  taken_ = std::max<std::int64_t>(1, taken_ / 2);
}

std::int64_t SampleAxis::begin(std::int64_t stratum, double fraction) const {
  const double place = (static_cast<double>(stratum) + fraction) * static_cast<double>(cells_);
  const auto at = static_cast<std::int64_t>(std::floor(place / static_cast<double>(taken_)));
  return first_ + std::min(at, cells_ - 1) * cell_;
}

}  // namespace weir
