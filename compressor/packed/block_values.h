// The values of a block as it is packed: all 512, in the order of a leaf.
#pragma once

#include <span>

#include "format/base/index.h"
#include "format/leaf/leaf_codec.h"

namespace weir {

/// From the in-domain values of a block, x fastest, to the order of a leaf (z fastest); the others as by
/// extend_outside. `inside` lies in the block's box `node`.
void block_values(std::span<const float> values, const Box& node, const Box& inside, LeafValues& block);

/// Gives voxels outside `inside` the value of the nearest one inside: the smoothest way to go on that needs no bounds.
void extend_outside(const Box& node, const Box& inside, LeafValues& block);

}  // namespace weir
