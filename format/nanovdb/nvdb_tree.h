// Validation of a grid's tree: after it, every child offset may be followed
// without a check. Walks root, upper and lower nodes; of the leaves it touches
// only the headers of the last few of an FpN grid, so that a mapped file of any
// size opens without reading its values.
#pragma once

#include <array>
#include <cstdint>
#include <functional>

#include "format/base/index.h"
#include "format/layout/nvdb_type.h"
#include "format/nanovdb/nvdb_bytes.h"

namespace weir {

/// All offsets in bytes from the grid's start.
struct NvdbTree {
  Box bbox;                                    ///< of active voxels, half open; {} where there are none
  std::uint32_t root_tiles = 0;                ///< entries of the root table
  std::array<std::uint32_t, 3> node_counts{};  ///< leaf, lower, upper
  std::array<std::uint32_t, 3> tile_counts{};  ///< active tiles as stored: lower, upper, root
  std::uint64_t active_voxels = 0;             ///< as stored
  std::uint64_t end = 0;                       ///< past the last byte of any node
};

/// Bytes of a leaf of a type of fixed size; 0 for FpN.
std::uint64_t fixed_leaf_bytes(GridType type);

/// Lowest voxel of the root tile `key`.
Index3 root_tile_origin(std::uint64_t key);

/// Checks the tree of `grid`, which has at least the fixed head. Guaranteed afterwards:
/// - the root table has no key twice; keys and boxes are those of 32-bit coordinates;
/// - upper and lower nodes are arrays of node_counts elements, each reached exactly once, so that a
///   walk visits no more than node_counts nodes;
/// - no entry is both value and child;
/// - the lower nodes have node_counts[0] leaf entries, each a leaf that lies inside the grid behind
///   the lower nodes, whatever width an FpN leaf has (see leaf_bits_log2);
/// - the bounding box lies within the root tiles and has less than 2^62 voxels (it may still be
///   sparse and huge: whoever allocates by box checks the box).
/// Throws Error(input) naming offset and value. `release`, where given, is called each time that some 8 MiB of nodes
/// have been looked at.
NvdbTree read_nvdb_tree(const NvdbBytes& grid, GridType type, const std::function<void()>& release = {});

/// The same of the head and the root table alone: nothing is known of the nodes, and `end` is past what the head says
/// of those of one size.
NvdbTree read_nvdb_tree_head(const NvdbBytes& grid, GridType type);

}  // namespace weir
