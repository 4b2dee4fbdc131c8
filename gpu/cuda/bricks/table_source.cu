#include "gpu/cuda/bricks/table_source.h"

#include "gpu/cuda/bricks/device_machine.cuh"
#include "gpu/cuda/bricks/region_entries.h"

namespace weir {

namespace {

/// Returns the position in the table of a block of the lattice.
template <class Block>
__device__ std::uint32_t table_position(const BlockTable<Block>& table, const BlockLattice& lattice,
                                        const Int3& block) {
  return table.index(
      {block.x - (lattice.shift.x >> 3), block.y - (lattice.shift.y >> 3), block.z - (lattice.shift.z >> 3)});
}

/// The `Blocks` of FillPages.
template <class Block>
struct TableBlocks {
  BlockTable<Block> source;

  __device__ PlainBlock at(const BlockLattice& lattice, const Int3& block) const {
    const Block found = source.blocks[table_position(source, lattice, block)];
    return {found.units == 0, found.tile_value()};
  }
};

/// Copies voxels. Runs for each voxel of each block.
template <class Block>
struct CopyVoxels {
  BlockTable<Block> source;
  BlockLattice lattice;
  const BlockId* blocks = nullptr;
  float* values = nullptr;

  __device__ void operator()(std::uint32_t i) const {
    const Block block = source.blocks[table_position(source, lattice, lattice.block_at(blocks[i / 512]))];
    values[i] = source.value(block, i % 512);
  }
};

}  // namespace

template <class Block>
TableSource<Block>::TableSource(const NvdbGrid& grid, const BlockTable<Block>& table)
    : grid_(grid), table_(table), lattice_(block_lattice(grid.index_bbox())) {}

template <class Block>
std::vector<RegionEntry> TableSource<Block>::regions() const {
  const NodeLattice regions = make_lattice(grid_.index_bbox(), kRegionDim);
  return region_entries(regions, [&](const Index3& at) {
    const GridBlock block = grid_.block_at(regions.node_box(at).lo);
    const bool tile = block.dim >= kRegionDim;
    return PlainBlock{tile, tile ? block.value : grid_.background()};
  });
}

template <class Block>
void TableSource<Block>::fill_pages(const std::uint32_t* regions, const std::uint32_t* pages, std::uint32_t count,
                                    const PageTable& table) {
  DeviceMachine{}.each(kRegionBlocks * count, FillPages<TableBlocks<Block>>{{table_}, table, regions, pages});
}

template <class Block>
void TableSource<Block>::decode(const BlockId* blocks, std::uint32_t count, float* values) {
  DeviceMachine{}.each(512 * count, CopyVoxels<Block>{table_, lattice_, blocks, values});
}

template class TableSource<FloatBlock>;
template class TableSource<QuantisedBlock>;

}  // namespace weir
