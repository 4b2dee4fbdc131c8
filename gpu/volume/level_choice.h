// Which level of detail a look-up reads: the level whose cubes of voxels are as wide as a pixel at the look-up's
// position. For host and device.
#pragma once

#include <cmath>

#include "gpu/math/vector3.h"

namespace weir {

/// The kinds of rays of a picture.
enum class RayKind {
  camera,     ///< seen directly by a pixel
  scattered,  ///< after a collision: the way on of the light, or the way to a light
};

/// The level depends only on the position: all rays of one kind see the same volume, filtered according to the
/// distance from the camera.
struct LevelChoice {
  Float3 eye;               ///< voxels from the domain's lowest corner
  Float3 stretch{1, 1, 1};  ///< edges of a voxel in units of the shortest edge
  float camera = 0;         ///< level at distance 1 in units of the shortest edge
  float scattered = 0;      ///< the same for RayKind::scattered

  WEIR_HOST_DEVICE float level(const Float3& p, RayKind kind) const {
    const Float3 way = (p - eye) * stretch;
    const float square = multiply_add(way.x, way.x, multiply_add(way.y, way.y, way.z * way.z));
    return multiply_add(0.5F, std::log2(square), kind == RayKind::camera ? camera : scattered);
  }
};

}  // namespace weir
