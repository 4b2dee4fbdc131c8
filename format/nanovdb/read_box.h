// Decoded values of a box of voxels, out of the tree they are stored in.
#pragma once

#include <span>

#include "format/base/index.h"
#include "format/nanovdb/nvdb_grid.h"

namespace weir {

/// What NvdbGrid::value gives for every voxel of `box`, in and outside the domain, x fastest, into `values`, which has
/// box.voxels() floats. A block is decoded once. Throws as NvdbGrid::block_at and decode_block.
void read_box(const NvdbGrid& grid, const Box& box, std::span<float> values);

/// The same of the voxels of `part`, which lies in `box`: the others of `values`, those of `box`, are left as they are.
void read_box_part(const NvdbGrid& grid, const Box& part, const Box& box, std::span<float> values);

}  // namespace weir
