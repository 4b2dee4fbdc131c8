// Writes texels of bricks to a texture in kernels.
#pragma once

#include <cuda_runtime_api.h>
#include <surface_indirect_functions.h>

#include <cstdint>

#include "gpu/math/vector3.h"

namespace weir {

/// `Texel` is float, or std::uint16_t, which the texture unit reads as a fraction of its largest value.
template <class Texel>
struct SurfaceTexels {
  static constexpr bool kSixteenBits = sizeof(Texel) == 2;

  cudaSurfaceObject_t surface = 0;

  WEIR_HOST_DEVICE void write([[maybe_unused]] const Int3& at, [[maybe_unused]] Texel value) const {
#if defined(__CUDA_ARCH__)
    surf3Dwrite(value, surface, at.x * static_cast<std::int32_t>(sizeof(Texel)), at.y, at.z);
#endif
  }
};

}  // namespace weir
