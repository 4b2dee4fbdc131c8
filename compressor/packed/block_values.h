// The values of a block for packing: all 512, in the order of a leaf (z fastest).
#pragma once

#include <span>

#include "format/base/index.h"
#include "format/leaf/leaf_codec.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// Copies the in-domain values of a block, x fastest, to `block` in the order of a leaf (z fastest). extend_outside()
/// (inside_voxels.h) gives the values outside the domain. `inside` lies in the block's box `node`.
void block_values(std::span<const float> values, const Box& node, const Box& inside, LeafValues& block);

/// Does the reverse: writes the in-domain values of `block` to `values`, x fastest, and returns them.
std::span<const float> in_domain_values(const float* block, const Box& node, const Box& inside, LeafValues& values);

/// Reads the `wanted` blocks of a box from their source: 512 values each, in the order of a leaf. extend_outside()
/// gives the values outside the volume. The box is read once. Throws as VolumeSource::read() does.
void read_blocks(VolumeSource& source, const NodeLattice& leaves, const Box& leaf_box, std::span<const Index3> wanted,
                 std::span<float> blocks);

}  // namespace weir
