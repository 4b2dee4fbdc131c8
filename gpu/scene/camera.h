// A pinhole camera. As the tracers need it, its position is in the volume's index space and its directions are in
// physical space.
#pragma once

#include "gpu/math/vector3.h"

namespace weir {

struct Camera {
  Float3 position;  ///< voxels from the domain's lowest corner
  Float3 forward;   ///< unit
  Float3 right;     ///< vector to the right edge of the picture at distance 1
  Float3 down;      ///< vector to the lower edge of the picture at distance 1

  /// Returns the unit direction through the picture at (u, v) in [0, 1]; (0, 0) is the upper left corner.
  WEIR_HOST_DEVICE Float3 direction(float u, float v) const {
    return normalised(forward + right * (2.0F * u - 1.0F) + down * (2.0F * v - 1.0F), forward);
  }
};

}  // namespace weir
