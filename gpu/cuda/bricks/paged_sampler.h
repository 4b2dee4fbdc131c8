// The volume that kernels render where its blocks are bricks of a texture, and some of them are missing. See
// gpu/volume/volume_sampler.h for what a tracer asks of it.
#pragma once

#include <cuda_runtime_api.h>
#include <texture_indirect_functions.h>

#include "gpu/cuda/bricks/brick_position.h"
#include "gpu/cuda/bricks/page_table.h"
#include "gpu/cuda/runtime/pixel_tile.h"
#include "gpu/math/random.h"
#include "gpu/volume/volume_sampler.h"

namespace weir {

/// As BrickSampler, with the same values.
template <Filter kFilter>
struct PagedSampler {
  PageTable table;
  cudaTextureObject_t texture = 0;

  WEIR_HOST_DEVICE float sample(const Float3& p, [[maybe_unused]] Random& random) const {
    if constexpr (kFilter == Filter::stochastic) {
      // One of the eight voxels around p, drawn by its weight: the one that covers p, moved by up to half a voxel.
      const Float3 moved{p.x - 0.5F + random.uniform(), p.y - 0.5F + random.uniform(), p.z - 0.5F + random.uniform()};
      return nearest(moved);
    } else {
      return smooth(p);
    }
  }

  WEIR_HOST_DEVICE float smooth(const Float3& p) const {
    if constexpr (kFilter == Filter::nearest) return nearest(p);
    return look_up({p.x - 0.5F, p.y - 0.5F, p.z - 0.5F});
  }

 private:
  WEIR_HOST_DEVICE float nearest(const Float3& p) const {
    return look_up({std::floor(p.x), std::floor(p.y), std::floor(p.z)});
  }

  // At local voxels, centres at whole numbers.
  WEIR_HOST_DEVICE float look_up(const Float3& q) const {
    const BrickPosition at(table.lattice, q);
    const BrickEntry entry = table.find_or_request(at.block);
#if defined(__CUDA_ARCH__)
    if ((entry.state & brick_state::kMissing) != 0) thread_missed() = true;
#endif
    if (entry.brick == 0) return entry.low;
    const Float3 texel = at.texel(entry);
#if defined(__CUDA_ARCH__)
    return entry.low + entry.span * tex3D<float>(texture, texel.x, texel.y, texel.z);
#else
    return texel.x * 0.0F;  // kernels alone see textures
#endif
  }
};

}  // namespace weir
