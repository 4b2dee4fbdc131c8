// The float leaf: 512 values of an 8^3 block, byte for byte as NanoVDB stores it.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "format/base/index.h"
#include "format/layout/nanovdb_layout.h"
#include "format/layout/node_statistics.h"
#include "format/leaf/leaf_head.h"

namespace weir {

/// The values of a leaf in the leaf's order: index x<<6 | y<<3 | z, z fastest.
using LeafValues = std::array<float, kLeafVoxels>;

/// Copies the in-domain values of one leaf from a dense block into leaf order; the other voxels become `outside`.
/// `values` holds `box` (index space, x fastest); `node` is the leaf's 8^3 box; `inside` = node & domain, not empty,
/// inside `box`.
void gather_leaf(std::span<const float> values, const Box& box, const Box& node, const Box& inside, float outside,
                 LeafValues& leaf);

/// Returns the statistics of the active values (those in `inside`), computed in mask order.
NodeStatistics leaf_statistics(const LeafValues& values, const Box& node, const Box& inside);

/// Returns the statistics of the voxels of `mask`, which is not empty.
NodeStatistics leaf_statistics(const LeafValues& values, const Box& node, const LeafMask& mask);

/// The number of leaves for which statistics are computed together. The arithmetic of one leaf is a chain of divisions
/// that wait for each other; sixteen chains at a time keep the machine busy.
inline constexpr std::size_t kLeafBatch = 16;

/// Computes the statistics of up to kLeafBatch leaves that lie wholly inside the domain, bit for bit as
/// leaf_statistics() does for each. `nodes` and `statistics` are as long as `leaves`.
void full_leaf_statistics(std::span<const LeafValues> leaves, std::span<const Box> nodes,
                          std::span<NodeStatistics> statistics);

/// Writes the 2144 bytes of a float leaf with the voxels of `inside` active.
void encode_float_leaf(const LeafValues& values, const Box& node, const Box& inside, const NodeStatistics& statistics,
                       std::span<std::byte, nvdb::kFloatLeafBytes> image);

}  // namespace weir
