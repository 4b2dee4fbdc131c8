// An internal node (16^3 entries in a lower node, 32^3 in an upper one) as it stands on disk.
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

  /// All entries are inactive tiles of value `background`.
  NodeImage(Level level, float background);

  /// Makes all entries background again, for reuse.
  void reset();

  /// Sets the entry at (x, y, z) of the node's table to a child that lies `bytes_from_node` bytes after the node.
  void set_child(const Index3& entry, std::uint64_t bytes_from_node);
  void set_tile(const Index3& entry, float value, bool active);
  /// Sets statistics and box of the active content; call it once, after all entries.
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
