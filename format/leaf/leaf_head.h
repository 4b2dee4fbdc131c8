// What all leaves begin with: the box and the mask of their active voxels.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "format/base/index.h"

namespace weir {

/// Zeroes the 96 bytes of a leaf's head and writes bounding box, flags and value mask of the active voxels
/// `inside` (not empty) the leaf at `node`. `flags` are added to "has a bounding box".
void write_leaf_head(const Box& node, const Box& inside, std::uint8_t flags, std::span<std::byte> image);

}  // namespace weir
