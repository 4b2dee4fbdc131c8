// Expands a packed grid for other readers by the device's steps, on the host.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "gpu/cuda/expand/leaf_steps.h"
#include "tests/gpu/bricks/host_machine.h"
#include "tests/support/expanded_file.h"

namespace weir::test {

struct Expanded {
  PackedBytes file;
  std::vector<LeafStatistics> leaves;
};

inline Expanded expand(const PackedFile& made, GridType type) {
  const NvdbGrid grid = NvdbGrid::open(made.file, "a.nvdb");
  const ExpandedTree tree(grid, type);
  const std::span<const std::uint64_t> blocks = tree.blocks();
  HostPackedSource source(*grid.packed(), grid.index_bbox());
  std::vector<float> values(512 * blocks.size());
  source.decode(blocks.data(), static_cast<std::uint32_t>(blocks.size()), values.data());
  // The leaves lie at a multiple of 32, as on a device.
  std::vector<std::uint64_t> memory(tree.bytes() / 8);
  const std::span<std::byte> bytes = std::as_writable_bytes(std::span(memory));
  Expanded expanded{{}, std::vector<LeafStatistics>(blocks.size())};
  WriteLeaves step;
  step.lattice = block_lattice(grid.index_bbox());
  step.corner = narrow(grid.packed()->regions().first * kRegionDim);
  step.background = grid.background();
  step.quantised = type == GridType::fp16;
  step.blocks = blocks.data();
  step.values = values.data();
  step.leaves = bytes.data() + tree.leaf_offset();
  step.statistics = expanded.leaves.data();
  HostMachine{}.groups(static_cast<std::uint32_t>(blocks.size()), step);
  tree.write(expanded.leaves, [&](std::uint64_t offset, std::span<const std::byte> part) {
    ASSERT_LE(offset + part.size(), bytes.size());
    std::copy(part.begin(), part.end(), bytes.begin() + static_cast<std::ptrdiff_t>(offset));
  });
  expanded.file = expanded_file(made.file, bytes, type);
  return expanded;
}

}  // namespace weir::test
