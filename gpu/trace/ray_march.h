// Direct volume rendering: computes the emission-absorption integral
//   L = int T(t) sigma(t) c(t) dt + T(end) behind,  T(t) = exp(-int_0^t sigma)
// by ray marching, with constant extinction in each step. Cells without opacity are skipped.
#pragma once

#include "gpu/math/random.h"
#include "gpu/scene/lighting.h"
#include "gpu/trace/medium.h"
#include "gpu/volume/volume_sampler.h"

namespace weir {

/// Transmittance below which a ray ends: an eighth of a step of 8-bit output. The emission of the rest and its
/// absorption of what is behind are left out, at most this fraction of either.
inline constexpr float kOpaque = 1.0F / 2048.0F;
/// Opacity of a ray up to which its samples stay unlit, because they are not worth the six look-ups of a gradient.
/// Their weights sum to this opacity, so the ray is off by at most this fraction of the difference between lit and
/// unlit colour.
inline constexpr float kUnshaded = 1.0F / 4096.0F;

/// Returns the radiance from unit `direction`. `voxel_step` is the distance between samples, in shortest voxel edges,
/// or in edges of the cubes of voxels that are looked up. `shading` in [0, 1] blends the colour with its reflection
/// of the lights on a surface across the gradient.
template <class Volume>
WEIR_HOST_DEVICE Float3 march(const Medium<Volume>& medium, const Lighting& lighting, const Float3& origin,
                              const Float3& direction, float voxel_step, float shading, Random& random) {
  Float3 radiance;
  float transmittance = 1.0F;
  Ray ray = medium.ray(origin, direction);
  const float length = enter(ray, medium.shown);
  // One lattice of samples along the whole ray, shifted at random. The cells only decide which samples to leave out.
  const float jitter = random.uniform();
  CellWalk walk(medium.cells, ray, 0.0F, length);
  CellSpan span;
  while (!(transmittance < kOpaque) && walk.next(medium.cells, ray, span)) {
    if (!(medium.majorant(span.cell) > 0.0F)) continue;
    const float step = medium.sample_step(voxel_step, ray.at(span.t0), length);
    float k = std::ceil(span.t0 / step - jitter);
    for (float t = (k + jitter) * step; t < span.t1; k += 1.0F, t = (k + jitter) * step) {
      const Float3 p = ray.at(t);
      const Rgba colour = medium.colour(p, RayKind::camera, random);
      const float sigma = medium.extinction(colour.a);
      if (!(sigma > 0.0F)) continue;
      const float through = std::exp(-sigma * step);
      const float weight = transmittance * (1.0F - through);
      transmittance *= through;
      Float3 emitted = rgb(colour);
      if (shading > 0.0F && transmittance < 1.0F - kUnshaded) {
        const Float3 slope = gradient(medium.volume, p) / medium.stretch;
        const Float3 normal = normalised(slope, direction);
        const Float3 facing = dot(normal, direction) > 0.0F ? -normal : normal;
        emitted = mix(emitted, emitted * lighting.on_surface(facing), shading);
      }
      radiance += emitted * weight;
      if (transmittance < kOpaque) break;
    }
  }
  return radiance + lighting.behind(direction) * transmittance;
}

}  // namespace weir
