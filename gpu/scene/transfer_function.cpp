#include "gpu/scene/transfer_function.h"

#include <algorithm>

#include "format/base/error.h"
#include "format/base/text.h"

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

}  // namespace weir
