// Levels of detail of a grid on the current device: textures of floats, which it filters.
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
  /// The finest level from `wanted` on that can be made within `bytes`; 0: none.
  static int finest_within(const LevelLattice& lattice, int wanted, std::uint64_t bytes);
  /// The levels from `first` on of all blocks of `source`, whose regions() are `regions`; `bytes` as above. Throws
  /// Error(io) where the device has no room, Error(input) where blocks are damaged.
  DevicePyramid(BlockSource& source, std::span<const RegionEntry> regions, int first, std::uint64_t bytes);

  LevelsView<TextureSampler> view() const;
  /// Of each of `cells`, whose voxels' bounds are `voxels` (device memory), what look-ups of this choice of levels may
  /// see in it (level_bounds.h); `drafts` as there.
  DeviceArray<MinMax> bounds(const CellLattice& cells, const MinMax* voxels, const LevelChoice& choice,
                             bool drafts) const;
  int first() const { return first_; }

 private:
  LevelLattice lattice_;
  int first_;
  std::vector<Texture> levels_;
};

}  // namespace weir
