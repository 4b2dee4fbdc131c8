// The blocks of a packed grid, from its packed data only: the tree is never read.
#pragma once

#include <functional>

#include "format/nanovdb/grid_block.h"
#include "format/nanovdb/packed_data.h"

namespace weir {

/// Returns what covers voxel `i` (any coordinates): a block of 8^3, a region of 128^3 without a chunk, or 128^3 voxels
/// of `background` outside the regions. Throws as PackedData::stream().
GridBlock packed_block_at(const PackedData& data, float background, const Index3& i);

/// Calls `visit` for all blocks that touch the index box, region by region in the order of the region table; within a
/// region x-major, z fastest. Throws as PackedData::stream().
void for_each_packed_block(const PackedData& data, const std::function<void(const GridBlock&)>& visit);

/// Calls `visit` for the blocks of the region at lattice position `position`.
void for_each_packed_block(const PackedData& data, const Index3& position,
                           const std::function<void(const GridBlock&)>& visit);

}  // namespace weir
