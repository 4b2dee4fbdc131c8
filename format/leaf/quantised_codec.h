// The quantised leaf, byte for byte as NanoVDB stores it: Fp4, Fp8, Fp16 and FpN.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "format/base/index.h"
#include "format/layout/node_statistics.h"
#include "format/layout/nvdb_type.h"

namespace weir {

/// Writes a leaf of 1 << bits_log2 bits a voxel (bits_log2 is 2, 3 or 4 for fp4, fp8 and fp16, up to 4 for fpn) with
/// the voxels of `inside` active. `image` holds quantised_leaf_bytes(bits_log2) bytes. `codes` are 512 in leaf order
/// (x<<6 | y<<3 | z), each below 2^bits; `statistics` are those of the decoded active values.
void encode_quantised_leaf(GridType type, std::span<const std::uint16_t, kLeafVoxels> codes, unsigned bits_log2,
                           float minimum, float quantum, const Box& node, const Box& inside,
                           const NodeStatistics& statistics, std::span<std::byte> image);

}  // namespace weir
