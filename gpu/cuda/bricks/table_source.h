// The blocks of a grid that the current device reads in place, through the grid's block table.
#pragma once

#include "format/nanovdb/nvdb_grid.h"
#include "gpu/cuda/bricks/block_source.h"
#include "gpu/cuda/volume/block_table.h"

namespace weir {

template <class Block>
class TableSource : public BlockSource {
 public:
  /// `grid` and the memory that `table` points to must outlive the object.
  TableSource(const NvdbGrid& grid, const BlockTable<Block>& table);

  BlockLattice lattice() const override { return lattice_; }
  std::vector<RegionEntry> regions() const override;
  void fill_pages(const std::uint32_t* regions, const std::uint32_t* pages, std::uint32_t count,
                  const PageTable& table) override;
  void decode(const BlockId* blocks, std::uint32_t count, float* values) override;
  void check() override {}

 private:
  const NvdbGrid& grid_;
  BlockTable<Block> table_;
  BlockLattice lattice_;
};

}  // namespace weir
