// Blocks of voxels as bricks of a 3-D texture, decoded, with the next voxel
// above, so that the texture unit filters them: trilinear at the price of one
// look-up. Blocks that are one value together with what borders on them above
// need no brick.
#pragma once

#include "gpu/cuda/runtime/device_array.h"
#include "gpu/cuda/volume/device_samplers.h"
#include "gpu/cuda/volume/texture.h"

namespace weir {

class BrickAtlas {
 public:
  /// Throws Error(io) where the device has no room, and leaves `spare` bytes of it free; Error(input) where there are
  /// more bricks than one texture holds.
  template <class Block>
  BrickAtlas(const BlockTable<Block>& table, std::uint64_t spare);

  const AtlasSampler& sampler() const { return sampler_; }
  std::uint64_t bricks() const { return bricks_; }
  std::uint64_t bytes() const { return entries_.bytes() + texture_.bytes(); }

 private:
  DeviceArray<BrickEntry> entries_;
  Texture texture_;
  AtlasSampler sampler_;
  std::uint64_t bricks_ = 0;
};

}  // namespace weir
