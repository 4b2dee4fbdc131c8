// Maximum intensity projection: finds the largest value along a ray, colours it by the transfer function and lays it
// over what is behind. Skips cells with no larger value than the one found so far.
#pragma once

#include "gpu/math/random.h"
#include "gpu/scene/lighting.h"
#include "gpu/trace/medium.h"
#include "gpu/volume/volume_sampler.h"

namespace weir {

/// Returns the largest finite value along a ray that `enter` has moved into the volume, or -infinity if there is
/// none. Samples are `voxel_step` apart, as in march().
template <class Volume>
WEIR_HOST_DEVICE float max_along(const Medium<Volume>& medium, const Ray& ray, float length, float voxel_step,
                                 float jitter) {
  float best = -kInfinity;
  CellWalk walk(medium.cells, ray, 0.0F, length);
  CellSpan span;
  while (walk.next(medium.cells, ray, span)) {
    if (medium.cell_values[span.cell].max <= best) continue;  // false if the bound is NaN, that is, unknown
    const float step = medium.sample_step(voxel_step, ray.at(span.t0), length);
    float k = std::ceil(span.t0 / step - jitter);
    for (float t = (k + jitter) * step; t < span.t1; k += 1.0F, t = (k + jitter) * step) {
      const float value = medium.volume.smooth(ray.at(t));
      if (value > best && is_finite(value)) best = value;
    }
  }
  return best;
}

/// Returns the radiance from unit `direction`.
template <class Volume>
WEIR_HOST_DEVICE Float3 project_max(const Medium<Volume>& medium, const Lighting& lighting, const Float3& origin,
                                    const Float3& direction, float step, Random& random) {
  Ray ray = medium.ray(origin, direction);
  const float length = enter(ray, medium.shown);
  const float best = max_along(medium, ray, length, step, random.uniform());
  const Rgba colour = medium.transfer.at(best);
  return mix(lighting.behind(direction), rgb(colour), colour.a);
}

}  // namespace weir
