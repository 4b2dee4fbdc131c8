// The volume that kernels render where its blocks are bricks of a texture, and some of them are missing. See
// gpu/volume/volume_sampler.h for what a tracer asks of it.
#pragma once

#include <cuda_runtime_api.h>
#include <texture_indirect_functions.h>

#include "gpu/cuda/bricks/fixed_point.h"
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
    const BlockLattice& l = table.lattice;
    return look_up(
        {lowest(p.x, l.extent.x, l.shift.x), lowest(p.y, l.extent.y, l.shift.y), lowest(p.z, l.extent.z, l.shift.z)});
  }

 private:
  // The lowest of the 2 x 2 x 2 voxels around a position names the block. Rounded to the 8 bits of weight that the
  // texture unit takes, so that its result does not depend on where a brick lies.
  WEIR_HOST_DEVICE static float lowest(float p, std::int32_t extent, std::int32_t shift) {
    const float q = clamped(p - 0.5F, 0.0F, static_cast<float>(extent - 1)) + (static_cast<float>(shift) + kFixedPoint);
    return q - kFixedPoint;
  }
  WEIR_HOST_DEVICE static float covering(float p, std::int32_t extent, std::int32_t shift) {
    return clamped(std::floor(p), 0.0F, static_cast<float>(extent - 1)) + static_cast<float>(shift);
  }
  WEIR_HOST_DEVICE float nearest(const Float3& p) const {
    const BlockLattice& l = table.lattice;
    return look_up({covering(p.x, l.extent.x, l.shift.x), covering(p.y, l.extent.y, l.shift.y),
                    covering(p.z, l.extent.z, l.shift.z)});
  }

  // At voxels from the first region's corner, centres at whole numbers.
  WEIR_HOST_DEVICE float look_up(const Float3& q) const {
    const Int3 b{static_cast<std::int32_t>(q.x) >> 3, static_cast<std::int32_t>(q.y) >> 3,
                 static_cast<std::int32_t>(q.z) >> 3};
    const BrickEntry entry = table.find_or_request(b);
#if defined(__CUDA_ARCH__)
    if ((entry.state & brick_state::kMissing) != 0) thread_missed() = true;
#endif
    if (entry.brick == 0) return entry.low;
    const Int3 corner = entry.corner();
    const Float3 at{q.x + static_cast<float>(corner.x - 8 * b.x) + 0.5F,
                    q.y + static_cast<float>(corner.y - 8 * b.y) + 0.5F,
                    q.z + static_cast<float>(corner.z - 8 * b.z) + 0.5F};
#if defined(__CUDA_ARCH__)
    return entry.low + entry.span * tex3D<float>(texture, at.x, at.y, at.z);
#else
    return at.x * 0.0F;  // kernels alone see textures
#endif
  }
};

}  // namespace weir
