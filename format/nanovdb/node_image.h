// An internal node (lower 16^3 or upper 32^3 entries) as it stands on disk.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "format/base/index.h"
#include "format/layout/nanovdb_layout.h"
#include "format/layout/node_statistics.h"

namespace weir {

class NodeImage {
 public:
  enum class Level { lower, upper };

  /// All entries are `background`, off.
  NodeImage(Level level, float background);

  /// Back to all background, for reuse.
  void reset();

  /// Entry at (x, y, z) of the node's table; the child lies `bytes_from_node` bytes after the node.
  void set_child(const Index3& entry, std::uint64_t bytes_from_node);
  void set_tile(const Index3& entry, float value, bool active);
  /// Statistics and box of the active content; call once, after all entries.
  void set_statistics(const NodeStatistics& statistics);

  std::span<const std::byte> bytes() const { return image_; }

 private:
  std::size_t position(const Index3& entry) const;

  const nvdb::InternalLayout& layout_;
  int log2_entries_;  // along an edge
  float background_;
  std::vector<std::byte> image_;
};

}  // namespace weir
