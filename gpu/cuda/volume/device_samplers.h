// The volumes that kernels render. All choices except the data are made at compile time. gpu/volume/volume_sampler.h
// says what a tracer asks of a volume.
#pragma once

#include "gpu/cuda/volume/block_table.h"
#include "gpu/cuda/volume/texture_read.h"

namespace weir {

/// Samples a block table.
template <class Block, Filter kFilter>
struct TableSampler {
  BlockTable<Block> table;

  WEIR_HOST_DEVICE float sample(const Float3& p, Random& random) const { return filtered().sample(p, random); }
  WEIR_HOST_DEVICE float smooth(const Float3& p) const { return filtered().smooth(p); }

 private:
  // The optimiser propagates the constant through everything that is inlined.
  WEIR_HOST_DEVICE FilteredVolume<BlockTable<Block>> filtered() const { return {table, kFilter}; }
};

/// Samples a dense texture: trilinearly by the texture unit, with weights of 8 bits, or the nearest voxel.
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
