// Walks the tree of a grid in a .vdb file without building it. The walk counts the nodes, finds the active voxels,
// and checks that the tree's parts are as long as OpenVDB assumes, because OpenVDB reads some of them without a
// check.
#pragma once

#include <array>
#include <cstdint>

#include "format/base/index.h"
#include "ingest/vdb/vdb_header.h"
#include "ingest/vdb/vdb_reader.h"
#include "ingest/vdb/vdb_type.h"

namespace weir {

struct VdbTopology {
  std::array<std::uint64_t, 3> nodes{};  ///< leaf, lower, upper
  std::uint64_t root_entries = 0;
  double background = 0;  ///< of a grid of real numbers; else 0
  Box active;             ///< bounding box of the active voxels and tiles; empty if there are none
};

/// Walks the tree at grid.tree_offset; skips over the values without unpacking them. After it returns, all nodes lie
/// on their lattice and none occurs twice, no entry is both tile and child, and every compressed run of values has
/// the required length. Throws Error(input) naming the offset and the value.
VdbTopology walk_vdb_tree(VdbReader& reader, const VdbGrid& grid, const VdbType& type);

}  // namespace weir
