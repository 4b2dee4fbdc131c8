// Levels of detail of a grid on the current device, as textures of floats that the texture unit filters.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "format/nanovdb/macrocells.h"
#include "gpu/cuda/bricks/block_source.h"
#include "gpu/cuda/runtime/device_array.h"
#include "gpu/cuda/volume/device_samplers.h"
#include "gpu/cuda/volume/texture.h"
#include "gpu/math/dda.h"
#include "gpu/volume/levelled_volume.h"

namespace weir {

class DevicePyramid {
 public:
  /// Returns the finest level from `wanted` on that can be made within `bytes`; 0: none.
  static int finest_within(const LevelLattice& lattice, int wanted, std::uint64_t bytes);
  /// Makes the levels from `first` on of all blocks of `source` within `bytes`; `regions` are its regions(). Throws
  /// Error(io) if the device has no room, Error(input) if blocks are damaged.
  DevicePyramid(BlockSource& source, std::span<const RegionEntry> regions, int first, std::uint64_t bytes);

  LevelsView<TextureSampler> view() const;
  /// Returns, for each of `cells`, the bounds of the values that look-ups with this choice of levels may read in it
  /// (level_bounds.h, also for `drafts`). `voxels` are the bounds of the cells' voxels in device memory.
  DeviceArray<MinMax> bounds(const CellLattice& cells, const MinMax* voxels, const LevelChoice& choice,
                             bool drafts) const;
  int first() const { return first_; }

 private:
  LevelLattice lattice_;
  int first_;
  std::vector<Texture> levels_;
};

}  // namespace weir
