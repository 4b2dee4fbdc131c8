// Which level of detail a look-up reads: the one whose cubes of voxels are as wide as a pixel where the look-up lies.
// For host and device.
#pragma once

#include <cmath>

#include "gpu/math/vector3.h"

namespace weir {

/// What a ray is to a picture.
enum class RayKind {
  camera,     ///< seen by a pixel
  scattered,  ///< from a collision on: the way light goes on, or comes from
};

/// The level depends on the position alone: all rays of a kind see one volume, filtered by its distance from the
/// camera.
struct LevelChoice {
  Float3 eye;               ///< voxels from the domain's lowest corner
  Float3 stretch{1, 1, 1};  ///< edges of a voxel, in units of the shortest
  float camera = 0;         ///< level at distance 1 of that unit
  float scattered = 0;      ///< the same for RayKind::scattered

  WEIR_HOST_DEVICE float level(const Float3& p, RayKind kind) const {
    const Float3 way = (p - eye) * stretch;
    const float square = multiply_add(way.x, way.x, multiply_add(way.y, way.y, way.z * way.z));
    return multiply_add(0.5F, std::log2(square), kind == RayKind::camera ? camera : scattered);
  }
};

}  // namespace weir
