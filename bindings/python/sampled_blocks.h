// Decodes the blocks that samples at given positions need, for grids that hold only some of their blocks.
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

/// Returns the blocks of 8^3 voxels that filtered look-ups at `positions` touch, each once, cut to `domain`, in voxels
/// from its lowest one. Positions are as in volume_sampler.h: x, y, z of one after the other.
std::vector<Box> sampled_blocks(std::span<const float> positions, const Box& domain);

/// The volume in which FilteredVolume looks up voxels.
class DecodedBlocks {
 public:
  /// `blocks` are from sampled_blocks(). Throws as NvdbGrid::decode_block().
  DecodedBlocks(const NvdbGrid& grid, std::span<const Box> blocks);

  Int3 extent;

  /// Returns a voxel of a decoded block; `i` counts from the lowest voxel.
  float voxel(const Int3& i) const;
  /// Reads the 2 x 2 x 2 voxels from `i` up, x fastest, clamped to the extent. Always returns false: all of `c` is set.
  /// (True would mean that one tile covers all eight voxels and only c[0] is set.)
  bool taps(const Int3& i, float (&c)[8]) const;

 private:
  using Values = std::array<float, kLeafVoxels>;
  // by block; shared, because a FilteredVolume holds a copy of this object
  std::shared_ptr<std::unordered_map<std::int64_t, Values>> blocks_;
  Index3 origin_;
  NodeLattice lattice_;
};

}  // namespace weir::python
