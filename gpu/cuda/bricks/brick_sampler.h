// The volume that kernels render if all of its blocks are bricks of a texture. Look-ups are most of what these
// kernels do. Fixed point numbers save conversions, which a device does at a quarter of the speed of sums.
#pragma once

#include "gpu/cuda/bricks/brick_table.h"
#include "gpu/cuda/bricks/filtered_bricks.h"

namespace weir {

template <Filter kFilter>
using BrickSampler = FilteredBricks<BrickTable, kFilter>;

}  // namespace weir
