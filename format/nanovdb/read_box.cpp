#include "format/nanovdb/read_box.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace weir {

void read_box(const NvdbGrid& grid, const Box& box, std::span<float> values) {
  if (box.empty()) return;
  const NodeLattice leaves = make_lattice(box, kLeafDim);
  std::array<float, kLeafVoxels> decoded;
  for_each_index({{}, leaves.count}, [&](const Index3& at) {
    const Box part = leaves.voxels(at);
    const Index3 corner = leaves.node_box(at).lo;
    const GridBlock block = grid.block_at(corner);
    if (block.leaf != nullptr) grid.decode_leaf(block.leaf, decoded);
    const auto run = static_cast<std::size_t>(part.extent().x);
    for (std::int64_t z = part.lo.z; z < part.hi.z; ++z) {
      for (std::int64_t y = part.lo.y; y < part.hi.y; ++y) {
        const auto first = static_cast<std::size_t>(linear_index(Index3{part.lo.x, y, z} - box.lo, box.extent()));
        const std::span<float> row = values.subspan(first, run);
        if (block.leaf == nullptr) {
          std::fill(row.begin(), row.end(), block.value);
          continue;
        }
        const Index3 in_leaf = Index3{part.lo.x, y, z} - corner;
        auto from = static_cast<std::size_t>(in_leaf.x << 6 | in_leaf.y << 3 | in_leaf.z);
        for (float& value : row) {
          value = decoded[from];
          from += kLeafDim * kLeafDim;
        }
      }
    }
  });
}

}  // namespace weir
