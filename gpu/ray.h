// A ray in index space. `direction` is the step in voxels per unit of length
// along the ray; its length is not 1 where voxels are not cubes.
#pragma once

#include "gpu/vector3.h"

namespace weir {

struct Ray {
  Float3 origin;
  Float3 direction;

  WEIR_HOST_DEVICE Float3 at(float t) const { return origin + direction * t; }
};

namespace detail {

// A component of exactly zero is decided by the origin alone: (face - origin) / 0 would be 0 / 0 for
// an origin on the face.
WEIR_HOST_DEVICE inline bool clip_slab(float origin, float direction, float extent, float& t0, float& t1) {
  if (direction == 0.0F) return origin >= 0.0F && origin < extent;
  const float a = (0.0F - origin) / direction;
  const float b = (extent - origin) / direction;
  t0 = greater(t0, lesser(a, b));
  t1 = lesser(t1, greater(a, b));
  return t0 < t1;
}

}  // namespace detail

/// Cuts [t0, t1] down to the part inside the box [0, extent); false where nothing is left of it.
WEIR_HOST_DEVICE inline bool clip(const Ray& ray, const Float3& extent, float& t0, float& t1) {
  return detail::clip_slab(ray.origin.x, ray.direction.x, extent.x, t0, t1) &&
         detail::clip_slab(ray.origin.y, ray.direction.y, extent.y, t0, t1) &&
         detail::clip_slab(ray.origin.z, ray.direction.z, extent.z, t0, t1);
}

/// Moves the origin to where the ray enters the box [0, extent) and returns the length inside, or 0
/// for a miss. Positions along the ray are then as precise as the volume, however far the camera.
WEIR_HOST_DEVICE inline float enter(Ray& ray, const Float3& extent) {
  float t0 = 0;
  float t1 = kInfinity;
  if (!clip(ray, extent, t0, t1) || !is_finite(t1)) return 0;
  ray.origin = ray.at(t0);
  return t1 - t0;
}

}  // namespace weir
