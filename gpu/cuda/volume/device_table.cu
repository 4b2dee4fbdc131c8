#include "gpu/cuda/volume/device_table.h"

#include <vector>

#include "gpu/cuda/runtime/launch_kernel.cuh"
#include "gpu/math/narrow.h"
#include "gpu/volume/leaf_table.h"

namespace weir {

namespace {

constexpr int kThreads = 256;

/// What covers the 4096^3 voxels of one position of the root's lattice.
struct RootCell {
  std::uint64_t upper = 0;  ///< offset of the upper node from the grid's start; 0: a tile or nothing
  float value = 0;
};

/// The tree as a kernel walks it.
struct TreeView {
  const std::byte* grid;
  const RootCell* roots;
  GridType type;
  Int3 root_count;
  Int3 block_count;
  Int3 first_block;  ///< first block of the lattice, relative to the first root cell's lowest block
};

__device__ bool bit(const std::byte* mask, std::uint32_t i) {
  return ((static_cast<unsigned>(mask[i >> 3U]) >> (i & 7U)) & 1U) != 0;
}

/// Returns the block at lattice position (x, y, z), relative to the first root cell's.
template <class Block>
__device__ Block find(const TreeView& tree, std::int32_t x, std::int32_t y, std::int32_t z) {
  const std::int64_t root_at = (x >> 9) + static_cast<std::int64_t>(tree.root_count.x) *
                                              ((y >> 9) + static_cast<std::int64_t>(tree.root_count.y) * (z >> 9));
  const RootCell& root = tree.roots[root_at];
  if (root.upper == 0) return Block::of_tile(root.value);
  const std::byte* upper = tree.grid + root.upper;
  const auto n = static_cast<std::uint32_t>((x >> 4 & 31) << 10 | (y >> 4 & 31) << 5 | (z >> 4 & 31));
  const std::byte* entry = upper + nvdb::kUpper.table + 8 * static_cast<std::size_t>(n);
  if (!bit(upper + nvdb::kUpper.child_mask, n)) return Block::of_tile(load<float>(entry));
  const std::byte* lower = upper + load<std::int64_t>(entry);
  const auto m = static_cast<std::uint32_t>((x & 15) << 8 | (y & 15) << 4 | (z & 15));
  entry = lower + nvdb::kLower.table + 8 * static_cast<std::size_t>(m);
  if (!bit(lower + nvdb::kLower.child_mask, m)) return Block::of_tile(load<float>(entry));
  const std::byte* leaf = lower + load<std::int64_t>(entry);
  const auto units = static_cast<std::uint64_t>(leaf - tree.grid) / nvdb::kAlignment;
  return Block::of_leaf(tree.type, leaf, static_cast<std::uint32_t>(units));
}

template <class Block>
__global__ void fill(TreeView tree, std::int64_t count, Block* blocks) {
  const std::int64_t i = static_cast<std::int64_t>(blockIdx.x) * kThreads + threadIdx.x;
  if (i >= count) return;
  const std::int64_t plane = static_cast<std::int64_t>(tree.block_count.x) * tree.block_count.y;
  blocks[i] = find<Block>(tree, static_cast<std::int32_t>(i % tree.block_count.x) + tree.first_block.x,
                          static_cast<std::int32_t>(i / tree.block_count.x % tree.block_count.y) + tree.first_block.y,
                          static_cast<std::int32_t>(i / plane) + tree.first_block.z);
}

std::vector<RootCell> root_cells(const NvdbGrid& grid, const NodeLattice& roots) {
  std::vector<RootCell> cells(static_cast<std::size_t>(roots.size()));
  for (RootCell& cell : cells) cell.value = grid.background();
  grid.for_each_root_entry([&](const RootEntry& entry) {
    const Index3 i = floor_div(entry.origin, kUpperDim) - roots.first;
    if (!Box{{0, 0, 0}, roots.count}.contains(i)) return;
    const std::byte* upper = entry.upper;
    cells[static_cast<std::size_t>(roots.linear(i))] = {
        upper == nullptr ? 0 : static_cast<std::uint64_t>(upper - grid.data().data()), entry.value};
  });
  return cells;
}

}  // namespace

template <class Block>
DeviceTable<Block>::DeviceTable(const NvdbGrid& grid, const std::byte* data) {
  const NodeLattice lattice = leaf_lattice(grid.index_bbox());
  check_entry_range(0, grid.data().size() / nvdb::kAlignment);
  const NodeLattice roots = make_lattice(lattice.domain, kUpperDim);
  const DeviceArray<RootCell> root_table(std::span<const RootCell>(root_cells(grid, roots)));
  const TreeView tree{data,
                      root_table.data(),
                      grid.type(),
                      narrow(roots.count),
                      narrow(lattice.count),
                      narrow(lattice.first - roots.first * (kUpperDim / kLeafDim))};
  blocks_ = DeviceArray<Block>(static_cast<std::size_t>(lattice.size()));
  const auto launched = static_cast<unsigned>((lattice.size() + kThreads - 1) / kThreads);
  launch_kernel("building the block table", {launched, kThreads, cudaStreamPerThread}, fill<Block>, tree,
                lattice.size(), blocks_.data());
  check_cuda(cudaStreamSynchronize(cudaStreamPerThread), "building the block table");
  view_ = {.blocks = blocks_.data(),
           .leaves = data,
           .count = narrow(lattice.count),
           .shift = narrow(lattice.domain.lo - lattice.first * kLeafDim),
           .extent = narrow(lattice.domain.extent())};
}

template class DeviceTable<FloatBlock>;
template class DeviceTable<QuantisedBlock>;

}  // namespace weir
