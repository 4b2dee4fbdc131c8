// Finds the values of one leaf in a block: among the values that were read, in a part of the block, or in the memory
// where the survey cached them.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "format/base/index.h"
#include "ingest/plan/block_stream.h"

namespace weir {

/// Buffers for the values of a leaf that lies in a part of a block.
struct LeafRoom {
  std::array<float, kLeafVoxels> values;
  std::array<float, kLeafVoxels> distinct;
};

struct LeafInBlock {
  std::span<const float> values;    ///< values of `voxels`, x fastest
  Box voxels;                       ///< contains the voxels of the leaf
  std::span<const float> distinct;  ///< the leaf's values without repeats; empty if none are known to repeat
  Index3 by{1, 1, 1};               ///< number of voxels along each axis that share one value
};

/// Finds the values of the leaf with the in-domain voxels `inside`. If the block is in parts, or if its leaves lie in
/// memory, the result holds the values of this leaf alone; they may lie in `room`.
LeafInBlock leaf_in_block(const Block& block, const Box& inside, LeafRoom& room);

/// Copies the values of `inside`, x fastest, out of `values`, the values of the box `voxels`, into `own`. Prefetches
/// the values that lie `ahead` values behind each row, for example those of a later leaf.
std::span<const float> copy_leaf(std::span<const float> values, const Box& voxels, const Box& inside,
                                 std::int64_t ahead, std::array<float, kLeafVoxels>& own);

}  // namespace weir
