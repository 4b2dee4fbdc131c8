// Validates a grid's tree: afterwards every child offset may be followed without a check. Walks root, upper and lower
// nodes. It reads only the headers of the last few leaves of an FpN grid, so that a mapped file of any size opens
// without reading its values.
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
  Box bbox;                                    ///< half-open box of active voxels; {} if there are none
  std::uint32_t root_tiles = 0;                ///< entries of the root table
  std::array<std::uint32_t, 3> node_counts{};  ///< leaf, lower, upper
  std::array<std::uint32_t, 3> tile_counts{};  ///< active tiles as stored: lower, upper, root
  std::uint64_t active_voxels = 0;             ///< as stored
  std::uint64_t end = 0;                       ///< past the last byte of any node
};

/// Returns the bytes of a leaf of a type with leaves of fixed size; 0 for FpN.
std::uint64_t fixed_leaf_bytes(GridType type);

/// Returns the lowest voxel of the root tile `key`.
Index3 root_tile_origin(std::uint64_t key);

/// Checks the tree of `grid`, which has at least the fixed head. Guaranteed afterwards:
/// - the root table has no key twice; keys and boxes are those of 32-bit coordinates;
/// - upper and lower nodes are arrays of node_counts elements, each reached exactly once, so that a
///   walk visits no more than node_counts nodes;
/// - no entry is both value and child;
/// - the lower nodes have node_counts[0] leaf entries, each a leaf that lies inside the grid behind
///   the lower nodes, whatever width an FpN leaf has (see leaf_bits_log2);
/// - the bounding box lies within the root tiles and has less than 2^62 voxels (it may still be
///   sparse and huge: check the box before you allocate memory for it).
/// Throws Error(input) that names offset and value. If `release` is given, it is called each time some 8 MiB of nodes
/// have been read.
NvdbTree read_nvdb_tree(const NvdbBytes& grid, GridType type, const std::function<void()>& release = {});

/// Checks the head and the root table only: the nodes are not checked, and `end` follows from the head's counts of the
/// nodes that have a fixed size.
NvdbTree read_nvdb_tree_head(const NvdbBytes& grid, GridType type);

}  // namespace weir
