// How kernels read textures.
#pragma once

#include <cuda_runtime_api.h>
#include <texture_indirect_functions.h>

#include "gpu/math/vector3.h"

namespace weir {

/// Returns a filtered texel as the texture unit delivers it. Only kernels can read textures.
WEIR_HOST_DEVICE inline float read_texture([[maybe_unused]] cudaTextureObject_t texture, const Float3& at) {
#if defined(__CUDA_ARCH__)
  return tex3D<float>(texture, at.x, at.y, at.z);
#else
  return at.x * 0.0F;
#endif
}

}  // namespace weir
