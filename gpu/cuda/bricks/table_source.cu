#include "gpu/cuda/bricks/table_source.h"

#include <algorithm>
#include <optional>

#include "gpu/cuda/bricks/device_machine.cuh"

namespace weir {

namespace {

/// Position in the table of a block of the lattice.
template <class Block>
__device__ std::uint32_t table_position(const BlockTable<Block>& table, const BlockLattice& lattice,
                                        const Int3& block) {
  return table.index(
      {block.x - (lattice.shift.x >> 3), block.y - (lattice.shift.y >> 3), block.z - (lattice.shift.z >> 3)});
}

template <class Block>
struct FillTablePages {
  BlockTable<Block> source;
  PageTable table;
  const std::uint32_t* regions = nullptr;
  const std::uint32_t* pages = nullptr;

  __device__ void operator()(std::uint32_t i) const {
    const BlockLattice& lattice = table.lattice;
    const std::uint32_t n = i / kRegionBlocks;
    const Int3 block = lattice.block_at(static_cast<BlockId>(regions[n]) * kRegionBlocks + i % kRegionBlocks);
    float value = 0;
    bool uniform = true;
    for (std::uint32_t k = 0; k < 8 && lattice.contains(block); ++k) {
      const Block other = source.blocks[table_position(source, lattice, lattice.above(block, k))];
      if (k == 0) value = other.tile_value();
      uniform = uniform && other.units == 0 && same_value(other.tile_value(), value);
    }
    table.entries[static_cast<std::size_t>(pages[n]) * kRegionBlocks + i % kRegionBlocks] = {
        value, 0, 0, uniform ? 0 : brick_state::kMissing};
  }
};

/// For each voxel of each block.
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
  const auto tile = [&](const Index3& at) {
    const GridBlock block = grid_.block_at(regions.node_box(at).lo);
    return block.dim >= kRegionDim ? std::optional(block.value) : std::nullopt;
  };
  std::vector<RegionEntry> entries(static_cast<std::size_t>(regions.size()));
  for (std::int64_t r = 0; r < regions.size(); ++r) {
    const Index3 at = regions.position(r);
    const std::optional<float> own = tile(at);
    bool uniform = own.has_value();
    for (std::int64_t k = 1; k < 8 && uniform; ++k) {
      const std::optional<float> above =
          tile({std::min(at.x + (k & 1), regions.count.x - 1), std::min(at.y + (k >> 1 & 1), regions.count.y - 1),
                std::min(at.z + (k >> 2), regions.count.z - 1)});
      uniform = above && same_value(*above, *own);
    }
    entries[static_cast<std::size_t>(r)] = {uniform ? 0 : RegionEntry::kMissing, own.value_or(grid_.background())};
  }
  return entries;
}

template <class Block>
void TableSource<Block>::fill_pages(const std::uint32_t* regions, const std::uint32_t* pages, std::uint32_t count,
                                    const PageTable& table) {
  DeviceMachine{}.each(kRegionBlocks * count, FillTablePages<Block>{table_, table, regions, pages});
}

template <class Block>
void TableSource<Block>::decode(const BlockId* blocks, std::uint32_t count, float* values) {
  DeviceMachine{}.each(512 * count, CopyVoxels<Block>{table_, lattice_, blocks, values});
}

template class TableSource<FloatBlock>;
template class TableSource<QuantisedBlock>;

}  // namespace weir
