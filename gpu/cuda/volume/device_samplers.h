// The volumes that kernels render, each with all choices but the data made at
// compile time. See gpu/volume/volume_sampler.h for what a tracer asks of them.
#pragma once

#include <cuda_runtime_api.h>
#include <texture_indirect_functions.h>

#include "gpu/cuda/volume/block_table.h"

namespace weir {

/// A block table.
template <class Block, Filter kFilter>
struct TableSampler {
  BlockTable<Block> table;

  WEIR_HOST_DEVICE float sample(const Float3& p, Random& random) const { return filtered().sample(p, random); }
  WEIR_HOST_DEVICE float smooth(const Float3& p) const { return filtered().smooth(p); }

 private:
  // The optimiser carries the constant through everything inlined.
  WEIR_HOST_DEVICE FilteredVolume<BlockTable<Block>> filtered() const { return {table, kFilter}; }
};

/// A dense texture: trilinear by the texture unit, which has 8 bits of each weight, or the nearest voxel.
struct TextureSampler {
  cudaTextureObject_t texture = 0;
  bool nearest = false;

  WEIR_HOST_DEVICE float sample(const Float3& p, Random&) const { return smooth(p); }
  WEIR_HOST_DEVICE float smooth(const Float3& p) const {
    const Float3 q = nearest ? Float3{std::floor(p.x) + 0.5F, std::floor(p.y) + 0.5F, std::floor(p.z) + 0.5F} : p;
#if defined(__CUDA_ARCH__)
    return tex3D<float>(texture, q.x, q.y, q.z);
#else
    return q.x * 0.0F;   // kernels alone see textures
#endif
  }
};

/// Voxels along a brick's edge: a block of 8 and the next voxel above it, so that all 2 x 2 x 2 neighbourhoods that
/// begin in the block lie in its brick.
inline constexpr std::int32_t kBrickEdge = 9;

/// What an atlas has for a block: a brick, or one value for all lookups that begin in the block.
struct alignas(8) BrickEntry {
  std::uint32_t brick = 0;  ///< position of the brick in units of bricks, 11 bits for x and y, 10 for z; 0: none
  float value = 0;

  WEIR_HOST_DEVICE static std::uint32_t pack(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    return x | y << 11U | z << 22U;
  }
  /// Texel of the brick's lowest voxel.
  WEIR_HOST_DEVICE Int3 corner() const {
    return {static_cast<std::int32_t>(brick & 2047U) * kBrickEdge,
            static_cast<std::int32_t>(brick >> 11U & 2047U) * kBrickEdge,
            static_cast<std::int32_t>(brick >> 22U) * kBrickEdge};
  }
};

/// A brick atlas: trilinear by the texture unit.
struct AtlasSampler {
  const BrickEntry* entries = nullptr;  ///< of the blocks, x fastest
  cudaTextureObject_t texture = 0;
  Int3 count;   ///< blocks along each axis
  Int3 shift;   ///< as BlockTable's
  Int3 extent;  ///< voxels

  WEIR_HOST_DEVICE float sample(const Float3& p, Random&) const { return smooth(p); }
  WEIR_HOST_DEVICE float smooth(const Float3& p) const {
    // As FilteredVolume: the lowest of the 2 x 2 x 2 voxels around p names the block.
    const Float3 q{lowest(p.x, extent.x, shift.x), lowest(p.y, extent.y, shift.y), lowest(p.z, extent.z, shift.z)};
    const Int3 b{static_cast<std::int32_t>(q.x) >> 3, static_cast<std::int32_t>(q.y) >> 3,
                 static_cast<std::int32_t>(q.z) >> 3};
    const BrickEntry entry = entries[table_index(b, count)];
    if (entry.brick == 0) return entry.value;
    const Int3 corner = entry.corner();
    const Float3 at{q.x + static_cast<float>(corner.x - 8 * b.x) + 0.5F,
                    q.y + static_cast<float>(corner.y - 8 * b.y) + 0.5F,
                    q.z + static_cast<float>(corner.z - 8 * b.z) + 0.5F};
#if defined(__CUDA_ARCH__)
    return tex3D<float>(texture, at.x, at.y, at.z);
#else
    return at.x * 0.0F;  // kernels alone see textures
#endif
  }

 private:
  WEIR_HOST_DEVICE static float lowest(float p, std::int32_t extent, std::int32_t shift) {
    return clamped(p - 0.5F, 0.0F, static_cast<float>(extent - 1)) + static_cast<float>(shift);
  }
};

}  // namespace weir
