#include "format/nanovdb/read_box.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace weir {

namespace {

// Fills the part `part` of `box` with one value.
void fill_part(const Box& box, const Box& part, float value, std::span<float> values) {
  const auto run = static_cast<std::size_t>(part.extent().x);
  for (std::int64_t z = part.lo.z; z < part.hi.z; ++z) {
    for (std::int64_t y = part.lo.y; y < part.hi.y; ++y) {
      const auto first = static_cast<std::size_t>(linear_index(Index3{part.lo.x, y, z} - box.lo, box.extent()));
      std::ranges::fill(values.subspan(first, run), value);
    }
  }
}

// Copies the voxels `part` from the block at `corner`, which has the values `decoded`.
void copy_part(const Box& box, const Box& part, const Index3& corner, const std::array<float, kLeafVoxels>& decoded,
               std::span<float> values) {
  const auto run = static_cast<std::size_t>(part.extent().x);
  for (std::int64_t z = part.lo.z; z < part.hi.z; ++z) {
    for (std::int64_t y = part.lo.y; y < part.hi.y; ++y) {
      const auto first = static_cast<std::size_t>(linear_index(Index3{part.lo.x, y, z} - box.lo, box.extent()));
      const Index3 in_block = Index3{part.lo.x, y, z} - corner;
      auto from = static_cast<std::size_t>(in_block.x << 6 | in_block.y << 3 | in_block.z);
      for (float& value : values.subspan(first, run)) {
        value = decoded[from];
        from += kLeafDim * kLeafDim;
      }
    }
  }
}

}  // namespace

void read_box(const NvdbGrid& grid, const Box& box, std::span<float> values) { read_box_part(grid, box, box, values); }

void read_box_part(const NvdbGrid& grid, const Box& part, const Box& box, std::span<float> values) {
  if (part.empty()) return;
  const Box inside = grid.packed() != nullptr ? intersect(part, grid.index_bbox()) : part;
  if (inside != part) fill_part(box, part, grid.background(), values);
  if (inside.empty()) return;
  const NodeLattice blocks = make_lattice(inside, kLeafDim);
  std::array<float, kLeafVoxels> decoded;
  for_each_index({{}, blocks.count}, [&](const Index3& at) {
    const Index3 corner = blocks.node_box(at).lo;
    const GridBlock block = grid.block_at(corner);
    if (!block.coded()) return fill_part(box, blocks.voxels(at), block.value, values);
    grid.decode_block(block, decoded);
    copy_part(box, blocks.voxels(at), corner, decoded, values);
  });
}

}  // namespace weir
