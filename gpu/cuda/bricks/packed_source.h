// The blocks of a packed grid, decoded on the current device.
#pragma once

#include "format/nanovdb/nvdb_grid.h"
#include "gpu/cuda/bricks/block_source.h"
#include "gpu/cuda/packed/block_decoder.h"

namespace weir {

class PackedSource : public BlockSource {
 public:
  /// `grid` is packed and must outlive the object; `data` is the device's address of its first byte.
  PackedSource(const NvdbGrid& grid, const std::byte* data);

  BlockLattice lattice() const override { return lattice_; }
  std::vector<RegionEntry> regions() const override;
  void fill_pages(const std::uint32_t* regions, const std::uint32_t* pages, std::uint32_t count,
                  const PageTable& table) override;
  void decode(const BlockId* blocks, std::uint32_t count, float* values) override;
  void check() override;

 private:
  const PackedData& packed_;
  BlockLattice lattice_;
  BlockDecoder decoder_;
  std::uint64_t damaged_ = 0;  // damaged blocks so far
};

}  // namespace weir
