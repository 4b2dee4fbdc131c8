// The values of one leaf in a block: among those that were read, in one of their parts, or in memory as the survey left
// it.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "format/base/index.h"
#include "ingest/plan/block_stream.h"

namespace weir {

/// Where values that lie in a part are put.
struct LeafRoom {
  std::array<float, kLeafVoxels> values;
  std::array<float, kLeafVoxels> distinct;
};

struct LeafInBlock {
  std::span<const float> values;  ///< of `voxels`, x fastest; those of the leaf among them
  Box voxels;
  std::span<const float> distinct;  ///< of the leaf, where some repeat each other, without those; else empty
  Index3 by{1, 1, 1};               ///< how many voxels have each along the axes
};

/// `inside`: the voxels of the leaf in the domain. Of a block in parts, and of one whose leaves lie in memory, the
/// values are those of the leaf alone, which may be in `room`.
LeafInBlock leaf_in_block(const Block& block, const Box& inside, LeafRoom& room);

/// Copies the values of a leaf, those of `inside`, x fastest, out of the values of `voxels`, in which it lies. What
/// lies `ahead` values behind each row, as those of a leaf to come do, is fetched into the cache meanwhile.
std::span<const float> copy_leaf(std::span<const float> values, const Box& voxels, const Box& inside,
                                 std::int64_t ahead, std::array<float, kLeafVoxels>& own);

}  // namespace weir
