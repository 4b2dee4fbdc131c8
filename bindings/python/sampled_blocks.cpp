#include "bindings/python/sampled_blocks.h"

#include <algorithm>
#include <cstddef>

#include "gpu/volume/leaf_table.h"

namespace weir::python {
namespace {

// Returns the lower of the two voxels along an axis that a look-up at `p` may touch; the other is the next voxel.
std::int64_t lower_voxel(float p, std::int64_t extent) {
  const auto last = static_cast<float>(extent - 1);
  return std::min(static_cast<std::int64_t>(std::clamp(p - 0.5F, 0.0F, last)), extent - 1);
}

}  // namespace

std::vector<Box> sampled_blocks(std::span<const float> positions, const Box& domain) {
  const NodeLattice lattice = make_lattice(domain, kLeafDim);
  const Index3 extent = domain.extent();
  std::vector<std::int64_t> numbers;
  for (std::size_t i = 0; i < positions.size(); i += 3) {
    const Index3 lo{lower_voxel(positions[i], extent.x), lower_voxel(positions[i + 1], extent.y),
                    lower_voxel(positions[i + 2], extent.z)};
    const Index3 hi = min(lo + Index3{1, 1, 1}, extent - Index3{1, 1, 1});
    const Index3 first = floor_div(domain.lo + lo, kLeafDim) - lattice.first;
    const Index3 last = floor_div(domain.lo + hi, kLeafDim) - lattice.first;
    for_each_index({first, last + Index3{1, 1, 1}}, [&](const Index3& at) { numbers.push_back(lattice.linear(at)); });
  }
  std::ranges::sort(numbers);
  const auto repeated = std::ranges::unique(numbers);
  numbers.erase(repeated.begin(), repeated.end());
  std::vector<Box> blocks;
  blocks.reserve(numbers.size());
  for (const std::int64_t number : numbers) {
    const Box voxels = lattice.voxels(lattice.position(number));
    blocks.push_back({voxels.lo - domain.lo, voxels.hi - domain.lo});
  }
  return blocks;
}

DecodedBlocks::DecodedBlocks(const NvdbGrid& grid, std::span<const Box> blocks)
    : blocks_(std::make_shared<std::unordered_map<std::int64_t, Values>>()),
      origin_(grid.index_bbox().lo),
      lattice_(make_lattice(grid.index_bbox(), kLeafDim)) {
  const Index3 size = grid.index_bbox().extent();
  extent = {static_cast<std::int32_t>(size.x), static_cast<std::int32_t>(size.y), static_cast<std::int32_t>(size.z)};
  for (const Box& block : blocks) {
    const Index3 voxel = origin_ + block.lo;
    const Index3 at = floor_div(voxel, kLeafDim) - lattice_.first;
    grid.decode_block(grid.block_at(voxel), (*blocks_)[lattice_.linear(at)]);
  }
}

float DecodedBlocks::voxel(const Int3& i) const {
  const Index3 voxel = origin_ + Index3{i.x, i.y, i.z};
  const Index3 block = floor_div(voxel, kLeafDim);
  const Index3 in_block = voxel - block * kLeafDim;
  const Values& values = blocks_->at(lattice_.linear(block - lattice_.first));
  return values[static_cast<std::size_t>(in_block.x << 6 | in_block.y << 3 | in_block.z)];
}

bool DecodedBlocks::taps(const Int3& i, float (&c)[8]) const {
  for (int k = 0; k < 8; ++k) {
    c[k] = voxel(
        {upper(i.x, (k & 1) != 0, extent.x), upper(i.y, (k & 2) != 0, extent.y), upper(i.z, (k & 4) != 0, extent.z)});
  }
  return false;
}

}  // namespace weir::python
