// The volume that kernels render where all of its blocks are bricks of a texture. Look-ups are most of what such
// kernels do: fixed point numbers save conversions, which a device does a quarter as fast as sums.
#pragma once

#include "gpu/cuda/bricks/brick_table.h"
#include "gpu/cuda/bricks/filtered_bricks.h"

namespace weir {

template <Filter kFilter>
using BrickSampler = FilteredBricks<BrickTable, kFilter>;

}  // namespace weir
