// GridBlock: the leaf, tile or stream that covers a voxel of a grid.
#pragma once

#include <cstddef>
#include <cstdint>

#include "format/base/index.h"
#include "format/nanovdb/packed_data.h"

namespace weir {

/// Either a coded block of 8^3 voxels (a leaf, or a stream of a packed grid), or one value for 8, 128 or 4096 voxels
/// along each edge: a tile, a part of a packed grid without a stream, or nothing (background).
struct GridBlock {
  Index3 origin;         ///< lowest voxel
  std::int64_t dim = 0;  ///< voxels along an edge: 8, 128 or 4096
  /// Tile state; true for leaves. In a packed grid: true for its regions, in which the voxels inside index_bbox() are
  /// active, and false outside of them.
  bool active = false;
  float value = 0;  ///< value of all voxels; unused if coded
  /// The leaf node, or null. It is 32-byte aligned relative to the grid, but a foreign file may hold the grid at any
  /// offset: read it through format/leaf/leaf_decode.h.
  const std::byte* leaf = nullptr;
  PackedStream stream = {};  ///< the stream of a block of a packed grid; empty if it has none

  /// Returns whether the voxels differ: then `dim` is 8, and NvdbGrid::decode_block() returns their values.
  bool coded() const { return leaf != nullptr || stream.data != nullptr; }
};

}  // namespace weir
