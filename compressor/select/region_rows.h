// Walks the rows region by region, in parallel, with bounded memory.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "compressor/select/tree_regions.h"
#include "compressor/survey/row_store.h"

namespace weir {

/// The rows of one 128^3 region; valid during the visit only.
class RegionRows {
 public:
  /// `rows` and, where given, `reaches` and `ladders` begin at the region's first leaf in arrays of `row_extent`.
  RegionRows(const LeafRow* rows, const Index3& row_extent, const Box& leaf_box, const MinMax* reaches = nullptr,
             const PackedLadder* ladders = nullptr)
      : rows_(rows), reaches_(reaches), ladders_(ladders), row_extent_(row_extent), leaf_box_(leaf_box) {}

  /// Returns the lattice positions of the region's leaves.
  const Box& leaf_box() const { return leaf_box_; }
  /// Returns the row of the leaf at lattice position `leaf`.
  const LeafRow& at(const Index3& leaf) const { return rows_[linear_index(leaf - leaf_box_.lo, row_extent_)]; }

  /// Returns the range of values that lookups in or next to `leaf` can give. Only if the store has reaches.
  const MinMax& reach(const Index3& leaf) const { return reaches_[linear_index(leaf - leaf_box_.lo, row_extent_)]; }

  /// Returns the ladder of the block at lattice position `leaf`. Only if the store has ladders.
  const PackedLadder& ladder(const Index3& leaf) const {
    return ladders_[linear_index(leaf - leaf_box_.lo, row_extent_)];
  }

  /// Calls visit(position, row) with x fastest, then y, then z: the order of the leaf index.
  template <typename Visit>
  void for_each(Visit&& visit) const {
    for (std::int64_t z = leaf_box_.lo.z; z < leaf_box_.hi.z; ++z) {
      for (std::int64_t y = leaf_box_.lo.y; y < leaf_box_.hi.y; ++y) {
        for (std::int64_t x = leaf_box_.lo.x; x < leaf_box_.hi.x; ++x) visit(Index3{x, y, z}, at({x, y, z}));
      }
    }
  }

 private:
  const LeafRow* rows_;
  const MinMax* reaches_;
  const PackedLadder* ladders_;
  Index3 row_extent_;
  Box leaf_box_;
};

/// Bytes of the rows and reaches of one region, and bytes of its ladders if blocks are packed.
inline constexpr std::uint64_t kRegionRowsBytes = 16ULL * 16 * 16 * (sizeof(LeafRow) + sizeof(MinMax));
inline constexpr std::uint64_t kRegionLaddersBytes = 16ULL * 16 * 16 * sizeof(PackedLadder);

/// Memory for the rows of a box of leaves.
struct RowBuffers {
  std::vector<LeafRow> rows;
  std::vector<MinMax> reaches;
  std::vector<PackedLadder> ladders;
};

/// Returns the rows of one region, read into `buffers` if they do not lie in memory.
RegionRows read_region(const RowStore& store, const Box& leaf_box, RowBuffers& buffers);

/// Calls visit(region index, rows) once for each region of a box of region-lattice positions. One thread visits a run
/// of neighbours in x one after the other. Runs are visited in parallel and in any order.
void for_each_region(const TreeRegions& tree, const RowStore& store, const Box& regions,
                     const std::function<void(std::int64_t, const RegionRows&)>& visit);

/// Does the same for the regions of this rank of the store's team: all regions if there is no other rank.
void for_each_own_region(const TreeRegions& tree, const RowStore& store,
                         const std::function<void(std::int64_t, const RegionRows&)>& visit);

}  // namespace weir
