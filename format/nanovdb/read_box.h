// Reads the decoded values of a box of voxels from the grid's tree or packed data.
#pragma once

#include <span>

#include "format/base/index.h"
#include "format/nanovdb/nvdb_grid.h"

namespace weir {

/// Writes NvdbGrid::value() of every voxel of `box`, in and outside the domain, x fastest, into `values`, which has
/// box.voxels() floats. Decodes each block once. Throws as NvdbGrid::block_at() and decode_block().
void read_box(const NvdbGrid& grid, const Box& box, std::span<float> values);

/// Like read_box(), but writes only the voxels of `part`, which lies in `box`. `values` holds `box`; its other values
/// stay as they are.
void read_box_part(const NvdbGrid& grid, const Box& part, const Box& box, std::span<float> values);

}  // namespace weir
