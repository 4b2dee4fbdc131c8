// The nearest and the farthest point of a box from another point.
#pragma once

#include "gpu/math/ray.h"

namespace weir {

/// Returns the point of `box` nearest to `p`; this is `p` itself if it lies inside.
WEIR_HOST_DEVICE inline Float3 nearest_point(const RayBox& box, const Float3& p) {
  return {clamped(p.x, box.low.x, box.high.x), clamped(p.y, box.low.y, box.high.y),
          clamped(p.z, box.low.z, box.high.z)};
}

/// Returns the corner of `box` farthest from `p`.
WEIR_HOST_DEVICE inline Float3 farthest_point(const RayBox& box, const Float3& p) {
  const auto farther = [](float at, float low, float high) { return at - low > high - at ? low : high; };
  return {farther(p.x, box.low.x, box.high.x), farther(p.y, box.low.y, box.high.y),
          farther(p.z, box.low.z, box.high.z)};
}

}  // namespace weir
