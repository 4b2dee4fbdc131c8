// Where everything lies in the file: from node counts to byte offsets. Order
// inside the grid: GridData, tree, root and its tiles, upper nodes, lower nodes,
// leaves, the blind records, the macrocells, packed data, padding to the asked size.
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
  std::uint64_t leaf_bytes = 0;  ///< of all leaves together
  std::uint64_t macrocells = 0;
  std::uint64_t leaf_tiles = 0;    ///< active tiles of 8^3 voxels, in lower nodes
  std::uint64_t packed_bytes = 0;  ///< of the packed data, a multiple of 4; 0: there is none
};

/// Byte offsets from the file's start, and sizes.
struct TreeLayout {
  NodeCounts counts;
  std::uint64_t grid = 0;
  std::uint64_t uppers = 0;
  std::uint64_t lowers = 0;
  std::uint64_t leaves = 0;
  std::uint64_t blind_meta = 0;
  std::uint64_t blind_data = 0;   ///< of the macrocells
  std::uint64_t packed_data = 0;  ///< where there is any
  std::uint64_t content_end = 0;  ///< padding begins here
  std::uint64_t file_bytes = 0;

  /// Records of blind data: the macrocells', and that of packed data where there is any.
  std::uint32_t blind_records() const { return counts.packed_bytes > 0 ? 2 : 1; }
  std::uint64_t grid_bytes() const { return file_bytes - grid; }
  /// Of all nodes, leaves included; of a packed file its preview.
  std::uint64_t node_bytes() const { return blind_meta - uppers; }
  std::uint64_t upper_offset(std::uint64_t i) const { return uppers + i * nvdb::kUpperBytes; }
  std::uint64_t lower_offset(std::uint64_t i) const { return lowers + i * nvdb::kLowerBytes; }
};

/// Whether NanoVDB, which counts the nodes and active tiles of a level in 32 bits, can count these.
bool countable(const NodeCounts& counts);

/// Throws Error(budget) where it cannot; `path` is that of the output, for the message.
void check_countable(const NodeCounts& counts, const std::string& path);

/// Layout without padding: file_bytes == content_end. Pads to nothing but the nodes' own alignment. Any counts have
/// one, also those that no file can have: what a full tree would take bounds what is asked.
TreeLayout make_layout(const NodeCounts& counts);

/// The same layout in a file of exactly `file_bytes` bytes, which is at least content_end.
TreeLayout padded_to(TreeLayout layout, std::uint64_t file_bytes);

}  // namespace weir
