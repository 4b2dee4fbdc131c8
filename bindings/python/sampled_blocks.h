// The blocks that samples at given positions look at, decoded: for grids of which not all blocks are there.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <unordered_map>
#include <vector>

#include "format/base/index.h"
#include "format/nanovdb/nvdb_grid.h"
#include "gpu/math/vector3.h"

namespace weir::python {

/// The blocks of 8^3 voxels that filtered look-ups at `positions` touch, each once, in voxels from the lowest one of
/// `domain`, and cut to it. Positions as of volume_sampler.h: x, y, z of one after the other.
std::vector<Box> sampled_blocks(std::span<const float> positions, const Box& domain);

/// What FilteredVolume looks voxels up in.
class DecodedBlocks {
 public:
  /// `blocks` of sampled_blocks. Throws as NvdbGrid::decode_block.
  DecodedBlocks(const NvdbGrid& grid, std::span<const Box> blocks);

  Int3 extent;

  /// Of a block that was decoded; voxels from the lowest one.
  float voxel(const Int3& i) const;
  /// The eight voxels from `i` up, x fastest, those beyond the extent clamped. False: all are set.
  bool taps(const Int3& i, float (&c)[8]) const;

 private:
  using Values = std::array<float, kLeafVoxels>;
  // By block; shared, since a FilteredVolume holds a copy.
  std::shared_ptr<std::unordered_map<std::int64_t, Values>> blocks_;
  Index3 origin_;
  NodeLattice lattice_;
};

}  // namespace weir::python
