// OpenVDB's trees behind weir's own names: its source alone includes OpenVDB.
#pragma once

#include <cstdint>
#include <istream>
#include <memory>
#include <string>

#include "ingest/vdb/leaf_source.h"
#include "ingest/vdb/vdb_header.h"
#include "ingest/vdb/vdb_topology.h"
#include "ingest/vdb/vdb_type.h"

namespace weir {

/// Memory that a tree of these nodes takes, with what an allocator adds, in bytes.
std::uint64_t vdb_tree_bytes(const VdbType& type, const VdbTopology& topology);

/// Builds the tree of `grid`, which walk_vdb_tree has looked at, from `in`, which throws at its end. Throws
/// Error(input), beginning with `where`, for what OpenVDB refuses: compressed values that do not unpack.
std::unique_ptr<LeafTree> load_vdb_tree(std::istream& in, const VdbHeader& header, const VdbGrid& grid,
                                        const VdbType& type, const std::string& where);

}  // namespace weir
