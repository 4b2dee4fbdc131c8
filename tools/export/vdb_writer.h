// Writes a NanoVDB grid as an OpenVDB file, node by node. OpenVDB's own tree, which takes 2 KiB and more per leaf, is
// never built.
#pragma once

#include <cstdint>
#include <functional>

#include "format/io/file_system.h"
#include "format/nanovdb/nvdb_grid.h"
#include "ingest/vdb/vdb_topology.h"
#include "tools/export/vdb_head.h"

namespace weir {

struct VdbWriterOptions {
  std::uint32_t compression = 0;  ///< kVdbZip, kVdbBlosc or neither; only active values are stored in any case
  bool half = false;              ///< values as 16-bit floats
  std::string creator;            ///< metadata of the file
  VdbMetadata metadata;           ///< of the grid, besides the entries that OpenVDB's tools know
  /// Called after every few thousand leaves with the share done, 0 to 1; may throw to stop.
  std::function<void(double)> progress;
  /// Called at the same times, when no pointer into the grid is held.
  std::function<void()> release_pages;
};

struct VdbWritten {
  std::uint64_t bytes = 0;  ///< of the file
  VdbTopology topology;     ///< nodes, and the box of the active voxels as the grid says it
  std::uint64_t active_voxels = 0;
  bool level_set = false;         ///< false: a fog volume
  double half_max_abs_error = 0;  ///< the largest over all finite values, inactive ones and tiles too
};

/// Writes `grid` to `file` from its first byte. Nodes, tiles, active states and values are those of the grid (for a
/// packed grid: the nodes of make_packed_export_tree). Values are bit for bit as NvdbGrid decodes them, or rounded to
/// 16 bits. The bytes do not depend on the number of threads. Uses all threads of TBB, and some 30 MiB besides the
/// grid's pages between two releases. Throws Error(input) for a transform that OpenVDB cannot read and for a damaged
/// leaf, Error(usage) for a finite value beyond kMaxHalf if `half` is set, and what `file` and the callbacks throw.
/// `path` is for messages.
VdbWritten write_vdb(const NvdbGrid& grid, const std::string& path, const VdbWriterOptions& options, File& file);

}  // namespace weir
