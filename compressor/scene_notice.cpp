#include "compressor/scene_notice.h"

#include <cmath>

#include "format/base/text.h"

namespace weir {

Message scene_notice(const Sidecar& sidecar, const std::string& output) {
  if (!sidecar.visible || sidecar.visible->blocks > 0) return {};
  const auto [low, high] = sidecar.value_range;
  const std::string values = std::isnan(low)
                                 ? "no value of which is finite"
                                 : cat("whose values are from ", short_number(low), " to ", short_number(high));
  return compose(output, ": ", sidecar.visible->scene, " shows nothing of ", sidecar.source.path, ", ", values,
                 "; correct its range, opacity or region, or leave out ", option("scene"));
}

}  // namespace weir
