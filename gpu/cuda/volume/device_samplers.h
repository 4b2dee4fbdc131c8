// The volumes that kernels render, each with all choices but the data made at
// compile time. See gpu/volume/volume_sampler.h for what a tracer asks of them.
#pragma once

#include "gpu/cuda/volume/block_table.h"
#include "gpu/cuda/volume/texture_read.h"

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
    return read_texture(texture, q);
  }
};

}  // namespace weir
