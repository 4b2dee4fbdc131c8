// The values of a block as it is packed: all 512, in the order of a leaf.
#pragma once

#include <span>

#include "format/base/index.h"
#include "format/leaf/leaf_codec.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// From the in-domain values of a block, x fastest, to the order of a leaf (z fastest); the others as by
/// extend_outside (inside_voxels.h). `inside` lies in the block's box `node`.
void block_values(std::span<const float> values, const Box& node, const Box& inside, LeafValues& block);

/// The other way round: the in-domain values of a block, x fastest, in `values`.
std::span<const float> in_domain_values(const float* block, const Box& node, const Box& inside, LeafValues& values);

/// Reads the values of some blocks of a box out of their source, 512 of each in the order of a leaf; those outside the
/// volume as by extend_outside. The box is read once. Throws as VolumeSource::read.
void read_blocks(VolumeSource& source, const NodeLattice& leaves, const Box& leaf_box, std::span<const Index3> wanted,
                 std::span<float> blocks);

}  // namespace weir
