// An implicit surface value(p) = iso. Cells with bounds that include the iso value are marched for a change of sign,
// which bisection then refines. The surface is matt and two-sided; its normal is the gradient.
#pragma once

#include "gpu/scene/lighting.h"
#include "gpu/trace/medium.h"
#include "gpu/volume/volume_sampler.h"

namespace weir {

/// Halvings of the interval that contains the surface: from half a voxel to 1e-5 of a voxel.
inline constexpr int kIsoRefinements = 16;

namespace detail {

WEIR_HOST_DEVICE inline bool crosses(float a, float b, float level) {
  return is_finite(a) && is_finite(b) && (a < level) != (b < level);
}

}  // namespace detail

/// Returns the parameter of the first place along a ray where values below iso meet iso or more, or -1. `enter` has
/// moved the ray into the volume. NaN and infinite values are on neither side. A blend of voxels that all have the
/// value iso may miss it by kBlendRounding. Values that little below iso therefore count as iso; otherwise rounding
/// in a plateau of this value would be a surface.
template <class Volume>
WEIR_HOST_DEVICE float find_iso(const Medium<Volume>& medium, const Ray& ray, float length, float iso,
                                float voxel_step) {
  const float rounding = kBlendRounding * std::abs(iso);
  CellWalk walk(medium.cells, ray, 0.0F, length);
  CellSpan span;
  while (walk.next(medium.cells, ray, span)) {
    const MinMax& bounds = medium.cell_values[span.cell];
    if (iso < bounds.min || iso > bounds.max) continue;
    float a = span.t0;
    float at_a = medium.volume.smooth(ray.at(a));
    const float step = medium.sample_step(voxel_step, ray.at(a), length);
    while (a < span.t1) {
      float b = lesser(a + step, span.t1);
      if (!(b > a)) break;  // a step below the precision of t
      const float at_b = medium.volume.smooth(ray.at(b));
      if (detail::crosses(at_a, at_b, iso - rounding)) {
        const bool on_plateau = std::abs(at_a - iso) <= rounding || std::abs(at_b - iso) <= rounding;
        const float level = on_plateau ? iso - rounding : iso;
        for (int i = 0; i < kIsoRefinements; ++i) {
          const float middle = 0.5F * (a + b);
          if ((medium.volume.smooth(ray.at(middle)) < level) == (at_a < level)) {
            a = middle;
          } else {
            b = middle;
          }
        }
        return b;
      }
      a = b;
      at_a = at_b;
    }
  }
  return -1.0F;
}

/// Returns the radiance from unit `direction`. The surface has the colour `colour`.
template <class Volume>
WEIR_HOST_DEVICE Float3 shade_iso(const Medium<Volume>& medium, const Lighting& lighting, const Float3& origin,
                                  const Float3& direction, float iso, const Float3& colour, float step) {
  Ray ray = medium.ray(origin, direction);
  const float length = enter(ray, medium.shown);
  const float t = find_iso(medium, ray, length, iso, step);
  if (t < 0.0F) return lighting.behind(direction);
  const Float3 normal = normalised(gradient(medium.volume, ray.at(t)) / medium.stretch, -direction);
  return colour * lighting.on_surface(dot(normal, direction) > 0.0F ? -normal : normal);
}

}  // namespace weir
