// Makes a packed grid into a grid that every NanoVDB reader knows: all of its bytes but the leaves, which are made
// elsewhere. The tree has a leaf for each block that has a stream or overhangs the domain, and tiles of 8^3 and 128^3
// voxels for the others. Voxels outside the domain are inactive. The macrocells are those of the packed grid.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "format/base/index.h"
#include "format/layout/node_statistics.h"
#include "format/layout/tree_layout.h"
#include "format/nanovdb/grid_head.h"
#include "format/nanovdb/nvdb_grid.h"

namespace weir {

/// Statistics of a leaf's active voxels, as NodeStatistics computes them.
struct LeafStatistics {
  float min;
  float max;
  double mean;
  double m2;
};

class ExpandedTree {
 public:
  /// `grid`, which is packed, must outlive the object; `type` is the type of the leaves, float32 or fp16. Throws as
  /// PackedData::for_each_stream(), and Error(budget) if NanoVDB cannot count the nodes.
  ExpandedTree(const NvdbGrid& grid, GridType type);

  std::uint64_t bytes() const { return layout_.grid_bytes(); }                 ///< bytes of the grid
  std::uint64_t leaf_offset() const { return layout_.leaves - layout_.grid; }  ///< from the grid's start
  static std::uint64_t leaf_bytes(GridType type);                              ///< bytes of one leaf
  /// Returns the blocks of the leaves, in the order of the leaves. A block is 4096 * linear index of its region (x
  /// fastest) + its position there (packed_position()).
  std::span<const std::uint64_t> blocks() const { return blocks_; }

  /// Receives bytes of the grid, at `offset` from the grid's start.
  using Sink = std::function<void(std::uint64_t offset, std::span<const std::byte> bytes)>;
  /// Writes everything but the leaves. `leaves` holds their statistics, in their order. Throws Error(input) if a leaf
  /// does not fit 16-bit codes.
  void write(std::span<const LeafStatistics> leaves, const Sink& sink) const;

 private:
  struct Lower {
    std::int64_t region;      // linear index
    std::uint64_t first = 0;  // index of its first leaf
  };
  struct Upper {
    Index3 origin;
    std::uint64_t first = 0;  // index of its first lower node
  };

  template <class Visit>
  void for_each_entry(const Upper& upper, const Visit& visit) const;
  void add_lower(std::int64_t region);
  NodeStatistics write_lower(std::uint64_t i, std::span<const LeafStatistics> leaves, const Sink& sink,
                             std::uint64_t& tiles) const;
  NodeStatistics write_upper(std::uint64_t i, std::span<const NodeStatistics> lowers, const Sink& sink,
                             std::uint64_t& tiles) const;

  const NvdbGrid& grid_;
  const PackedData& packed_;
  GridType type_;
  Box domain_;
  std::vector<Upper> uppers_;
  std::vector<Lower> lowers_;
  std::vector<std::uint64_t> blocks_;
  TreeLayout layout_;
};

}  // namespace weir
