// How a volume is cut into blocks that the memory ceiling holds. A pure
// function; results of a conversion never depend on it.
#pragma once

#include <cstdint>
#include <vector>

#include "format/index.h"
#include "ingest/volume_source.h"

namespace weir {

/// A regular cut of the leaf lattice of a domain: blocks of `leaves` leaves (the last ones smaller).
struct BlockPlan {
  NodeLattice lattice;            ///< leaves (dim 8) over the domain
  Index3 leaves;                  ///< leaves per block along each axis
  Index3 count;                   ///< blocks along each axis
  std::uint64_t block_bytes = 0;  ///< float32 bytes of the largest block
  std::int64_t run_voxels = 0;    ///< length of the contiguous runs in a row-major file, in voxels
  double amplification = 1.0;     ///< chunk decodes / chunks: 1 where none is decoded twice

  std::int64_t size() const { return volume(count); }
  /// Leaves of block i as a half-open box of lattice positions; x fastest, then y, then z.
  Box leaf_box(std::int64_t i) const;
  /// In-domain voxels of a box of lattice positions, in index space.
  Box voxel_box(const Box& leaf_box) const;
};

/// Largest blocks whose float32 values fit `block_bytes`: whole rows of lower nodes (128 deep, full
/// rows in x, as many node rows in y as fit) where that fits; otherwise fewer leaf layers, then
/// fewer leaf rows, and x is cut last; chunked sources get whole chunks where possible. A block is
/// never smaller than one leaf. Throws Error(usage) when not even one leaf fits.
BlockPlan plan_blocks(const Box& domain, const AccessShape& access, std::uint64_t block_bytes);

}  // namespace weir
