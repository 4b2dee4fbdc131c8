// The beginning of every leaf: the box and the mask of its active voxels.
#pragma once

#include <bitset>
#include <cstddef>
#include <cstdint>
#include <span>

#include "format/base/index.h"
#include "format/layout/nanovdb_layout.h"

namespace weir {

/// Zeroes the 96 bytes of a leaf's head and writes bounding box, flags and value mask. `inside` (not empty) holds the
/// active voxels of the leaf at `node`. `flags` are added to "has a bounding box".
void write_leaf_head(const Box& node, const Box& inside, std::uint8_t flags, std::span<std::byte> image);

/// The active voxels of a leaf: bit x<<6 | y<<3 | z.
using LeafMask = std::bitset<kLeafVoxels>;

/// Returns the box of the voxels of `mask`, which is not empty, for the leaf at `node`.
Box box_of(const LeafMask& mask, const Box& node);

/// Replaces mask and bounding box in the head of a leaf by those of `mask`, which is not empty.
void set_active_voxels(const Box& node, const LeafMask& mask, std::span<std::byte> image);

}  // namespace weir
