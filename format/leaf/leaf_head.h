// What all leaves begin with: the box and the mask of their active voxels.
#pragma once

#include <bitset>
#include <cstddef>
#include <cstdint>
#include <span>

#include "format/base/index.h"
#include "format/layout/nanovdb_layout.h"

namespace weir {

/// Zeroes the 96 bytes of a leaf's head and writes bounding box, flags and value mask of the active voxels
/// `inside` (not empty) the leaf at `node`. `flags` are added to "has a bounding box".
void write_leaf_head(const Box& node, const Box& inside, std::uint8_t flags, std::span<std::byte> image);

/// Active voxels of a leaf: bit x<<6 | y<<3 | z.
using LeafMask = std::bitset<kLeafVoxels>;

/// The box of the voxels of `mask`, which has some, of the leaf at `node`.
Box box_of(const LeafMask& mask, const Box& node);

/// Replaces mask and bounding box in the head of a leaf by those of `mask`, which has voxels.
void set_active_voxels(const Box& node, const LeafMask& mask, std::span<std::byte> image);

}  // namespace weir
