// A ray in index space. `direction` is the step in voxels per unit of length along the ray. Its length is not 1 if
// voxels are not cubes.
#pragma once

#include "gpu/math/vector3.h"

namespace weir {

struct Ray {
  Float3 origin;
  Float3 direction;

  WEIR_HOST_DEVICE Float3 at(float t) const { return origin + direction * t; }
};

namespace detail {

// If a component is exactly zero, the origin alone decides: (face - origin) / 0 would be 0 / 0 for an origin on the
// face.
WEIR_HOST_DEVICE inline bool clip_slab(float origin, float direction, float low, float high, float& t0, float& t1) {
  if (direction == 0.0F) return origin >= low && origin < high;
  const float a = (low - origin) / direction;
  const float b = (high - origin) / direction;
  t0 = greater(t0, lesser(a, b));
  t1 = lesser(t1, greater(a, b));
  return t0 < t1;
}

}  // namespace detail

/// In voxel coordinates; `low` is inclusive, `high` exclusive.
struct RayBox {
  Float3 low;
  Float3 high;
};

/// Cuts [t0, t1] down to the part inside the box. Returns false if nothing is left.
WEIR_HOST_DEVICE inline bool clip(const Ray& ray, const RayBox& box, float& t0, float& t1) {
  return detail::clip_slab(ray.origin.x, ray.direction.x, box.low.x, box.high.x, t0, t1) &&
         detail::clip_slab(ray.origin.y, ray.direction.y, box.low.y, box.high.y, t0, t1) &&
         detail::clip_slab(ray.origin.z, ray.direction.z, box.low.z, box.high.z, t0, t1);
}

/// Moves the origin to where the ray enters the box. Returns the length inside, or 0 for a miss. Afterwards positions
/// along the ray are as precise as the volume allows, however far the camera is.
WEIR_HOST_DEVICE inline float enter(Ray& ray, const RayBox& box) {
  float t0 = 0;
  float t1 = kInfinity;
  if (!clip(ray, box, t0, t1) || !is_finite(t1)) return 0;
  ray.origin = ray.at(t0);
  return t1 - t0;
}

}  // namespace weir
