// What covers a voxel of a grid.
#pragma once

#include <cstddef>
#include <cstdint>

#include "format/base/index.h"
#include "format/nanovdb/packed_data.h"

namespace weir {

/// A coded block of 8^3 voxels (a leaf, or a stream of a packed grid), or one value for 8, 128 or 4096 voxels along
/// each edge: a tile, or what a packed grid has without a stream, or nothing (background).
struct GridBlock {
  Index3 origin;         ///< lowest voxel
  std::int64_t dim = 0;  ///< voxels along an edge: 8, 128 or 4096
  /// Tile state; true for leaves. In a packed grid: true, and the voxels inside index_bbox() are active; false outside
  /// its regions.
  bool active = false;
  float value = 0;  ///< of all voxels; unused where coded
  /// Leaf node, else null; 32-byte aligned relative to the grid, which a foreign file may hold
  /// at any offset: read it through format/leaf/leaf_decode.h.
  const std::byte* leaf = nullptr;
  PackedStream stream = {};  ///< of a block of a packed grid that has one

  /// Whether voxels differ: then dim is 8, and NvdbGrid::decode_block tells them.
  bool coded() const { return leaf != nullptr || stream.data != nullptr; }
};

}  // namespace weir
