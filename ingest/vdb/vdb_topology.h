// The tree of a grid in a .vdb file walked without building it: how many nodes
// it has, which voxels are active, and whether its parts are as long as OpenVDB takes them to be, since OpenVDB reads
// some of them without a check.
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
  Box active;             ///< bounding box of the active voxels and tiles; empty where there are none
};

/// Walks the tree at grid.tree_offset, values included but not unpacked. Afterwards: nodes lie on their lattice and
/// none twice, no entry is both tile and child, and every compressed run of values is of the length it must have.
/// Throws Error(input) naming the offset and the value.
VdbTopology walk_vdb_tree(VdbReader& reader, const VdbGrid& grid, const VdbType& type);

}  // namespace weir
