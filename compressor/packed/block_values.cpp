#include "compressor/packed/block_values.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "compressor/leaf/inside_voxels.h"
#include "format/base/simd.h"

namespace weir {
namespace {

WEIR_SIMD void transpose_block(const float* values, float* block) {
  for (std::size_t x = 0; x < 8; ++x) {
    for (std::size_t y = 0; y < 8; ++y) {
      for (std::size_t z = 0; z < 8; ++z) block[x << 6U | y << 3U | z] = values[z << 6U | y << 3U | x];
    }
  }
}

}  // namespace

void block_values(std::span<const float> values, const Box& node, const Box& inside, LeafValues& block) {
  if (inside == node) return transpose_block(values.data(), block.data());
  const Index3 lo = inside.lo - node.lo;
  const Index3 extent = inside.extent();
  std::size_t at = 0;
  for (std::int64_t z = 0; z < extent.z; ++z) {
    for (std::int64_t y = 0; y < extent.y; ++y) {
      for (std::int64_t x = 0; x < extent.x; ++x) {
        block[static_cast<std::size_t>((lo.x + x) << 6 | (lo.y + y) << 3 | (lo.z + z))] = values[at++];
      }
    }
  }
  extend_outside(node, inside, block);
}

std::span<const float> in_domain_values(const float* block, const Box& node, const Box& inside, LeafValues& values) {
  const Index3 lo = inside.lo - node.lo;
  const Index3 hi = inside.hi - node.lo;
  std::size_t count = 0;
  for (std::int64_t z = lo.z; z < hi.z; ++z) {
    for (std::int64_t y = lo.y; y < hi.y; ++y) {
      for (std::int64_t x = lo.x; x < hi.x; ++x) values[count++] = block[x << 6 | y << 3 | z];
    }
  }
  return std::span(values).first(count);
}

void read_blocks(VolumeSource& source, const NodeLattice& leaves, const Box& leaf_box, std::span<const Index3> wanted,
                 std::span<float> blocks) {
  const Box voxels = leaves.voxels(leaf_box);
  std::vector<float> values(static_cast<std::size_t>(voxels.voxels()));
  source.read(voxels, values);
  LeafValues block;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const Box node = leaves.node_box(wanted[i]);
    const Box inside = leaves.voxels(wanted[i]);
    gather_leaf(values, voxels, node, inside, 0, block);
    extend_outside(node, inside, block);
    std::copy(block.begin(), block.end(), blocks.begin() + static_cast<std::ptrdiff_t>(kLeafVoxels * i));
  }
}

}  // namespace weir
