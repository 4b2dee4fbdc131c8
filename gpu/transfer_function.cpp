#include "gpu/transfer_function.h"

#include <algorithm>
#include <cfloat>

#include "format/error.h"
#include "format/text.h"

namespace weir {

namespace {

RangeMax opacities_of(const std::vector<Rgba>& table) {
  std::vector<float> opacities(table.size());
  std::transform(table.begin(), table.end(), opacities.begin(), [](const Rgba& c) { return c.a; });
  return RangeMax(std::move(opacities));
}

}  // namespace

TransferFunction::TransferFunction(std::vector<Rgba> table, float low, float high)
    : table_(std::move(table)), opacities_(opacities_of(table_)), low_(low), high_(high) {
  if (table_.size() < 2 || !is_finite(low) || !is_finite(high) || low > high) {
    throw Error(ErrorKind::internal, cat("transfer function of ", table_.size(), " entries over [", low, ", ", high,
                                         "]; at least 2 over a finite range are needed"));
  }
  const float scale = is_finite(high - low) ? 1.0F : 0.25F;
  view_ = {.table = table_.data(),
           .last = static_cast<float>(table_.size() - 1),
           .low = low * scale,
           .width = high * scale - low * scale,
           .scale = scale};
}

float TransferFunction::max_opacity(float low, float high) const {
  if (!(low <= high) || !is_finite(low) || !is_finite(high)) return opacities_.between(0, table_.size() - 1);
  // A filtered value may round past the voxels it came from, by a few ulp of the larger of them.
  const float slack = 4 * FLT_EPSILON * std::max(std::abs(low), std::abs(high));
  const float first = view_.position(std::max(low - slack, -FLT_MAX));
  const float last = view_.position(std::min(high + slack, FLT_MAX));
  // Positions grow with values and the opacity is linear between entries: its largest value is at an
  // entry inside the interval or at one of the two ends.
  const auto opacity = [&](float u) {
    const auto i = static_cast<std::size_t>(u);
    return mix(table_[i].a, table_[std::min(i + 1, table_.size() - 1)].a, u - static_cast<float>(i));
  };
  float result = std::max(opacity(first), opacity(last));
  const auto from = static_cast<std::size_t>(std::ceil(first));
  const auto until = static_cast<std::size_t>(last);
  if (from <= until) result = std::max(result, opacities_.between(from, until));
  return result * (1.0F + 4 * FLT_EPSILON);
}

}  // namespace weir
