// The layout of the file: from node counts to byte offsets. Order inside the grid: GridData, tree, root and its tiles,
// upper nodes, lower nodes, leaves, the blind records, the macrocells, packed data, padding to the requested size.
#pragma once

#include <cstdint>
#include <string>

#include "format/layout/nanovdb_layout.h"

namespace weir {

struct NodeCounts {
  std::uint64_t root_tiles = 0;  ///< entries of the root table: children and value tiles
  std::uint64_t uppers = 0;
  std::uint64_t lowers = 0;
  std::uint64_t leaves = 0;
  std::uint64_t leaf_bytes = 0;  ///< bytes of all leaves together
  std::uint64_t macrocells = 0;
  std::uint64_t leaf_tiles = 0;    ///< active tiles of 8^3 voxels, in lower nodes
  std::uint64_t packed_bytes = 0;  ///< bytes of the packed data, a multiple of 4; 0: there is none
};

/// Byte offsets from the file's start, and sizes.
struct TreeLayout {
  NodeCounts counts;
  std::uint64_t grid = 0;
  std::uint64_t uppers = 0;
  std::uint64_t lowers = 0;
  std::uint64_t leaves = 0;
  std::uint64_t blind_meta = 0;
  std::uint64_t blind_data = 0;   ///< the macrocells' data
  std::uint64_t packed_data = 0;  ///< the packed data, if there is any
  std::uint64_t content_end = 0;  ///< padding begins here
  std::uint64_t file_bytes = 0;

  /// Returns the number of blind data records: one for the macrocells, and one for packed data if there is any.
  std::uint32_t blind_records() const { return counts.packed_bytes > 0 ? 2 : 1; }
  std::uint64_t grid_bytes() const { return file_bytes - grid; }
  /// Returns the bytes of all nodes, leaves included; in a packed file these are the preview.
  std::uint64_t node_bytes() const { return blind_meta - uppers; }
  std::uint64_t upper_offset(std::uint64_t i) const { return uppers + i * nvdb::kUpperBytes; }
  std::uint64_t lower_offset(std::uint64_t i) const { return lowers + i * nvdb::kLowerBytes; }
};

/// Returns whether NanoVDB can count the nodes: it counts the nodes and active tiles of a level in 32 bits.
bool countable(const NodeCounts& counts);

/// Throws Error(budget) if countable() is false; `path` is the output's path, for the message.
void check_countable(const NodeCounts& counts, const std::string& path);

/// Returns the layout without padding: file_bytes == content_end. The only gaps are for the alignment of nodes. Also
/// works for counts that no file can have, so that callers can ask for the size of a full tree as a bound.
TreeLayout make_layout(const NodeCounts& counts);

/// Returns the same layout in a file of exactly `file_bytes` bytes, which is at least content_end.
TreeLayout padded_to(TreeLayout layout, std::uint64_t file_bytes);

}  // namespace weir
