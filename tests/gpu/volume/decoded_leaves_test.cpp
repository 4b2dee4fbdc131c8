#include "gpu/volume/decoded_leaves.h"

#include <gtest/gtest.h>

#include <utility>

#include "format/base/error.h"
#include "gpu/volume/leaf_table.h"
#include "gpu/volume/macrocell_grid.h"
#include "tests/support/message_of_error.h"
#include "tests/support/packed_sample.h"

namespace weir::decoded_leaves_test {
namespace {

using test::PackedSample;

TEST(DecodedLeaves, LeafTable_PackedGrid_HasTheDecodedVoxels) {
  const test::PackedFile made = PackedSample::build();
  const NvdbGrid grid = NvdbGrid::open(made.file, "a.nvdb");
  LeafTable first(grid);
  const LeafTable table = std::move(first);
  const auto kinds = PackedSample::blocks_by_kind();
  EXPECT_GT(table.bytes(), (kinds[0] + kinds[1]) * nvdb::kFloatLeafBytes);
  const Box domain = PackedSample::kDomain;
  for_each_index(domain, [&](const Index3& i) {
    const Index3 at = i - domain.lo;
    const Int3 local{static_cast<std::int32_t>(at.x), static_cast<std::int32_t>(at.y), static_cast<std::int32_t>(at.z)};
    ASSERT_EQ(table.view().voxel(local), PackedSample::value(i)) << i.x << ' ' << i.y << ' ' << i.z;
  });
}

TEST(DecodedLeaves, DamagedStream_IsReported) {
  test::PackedFile made = PackedSample::build();
  const NvdbGrid whole = NvdbGrid::open(made.file, "a.nvdb");
  GridBlock last;
  whole.for_each_block([&](const GridBlock& block) { last = block.coded() ? block : last; });
  const auto at = static_cast<std::uint64_t>(last.stream.data - made.file.data());
  made.file[at] |= std::byte{0x80};
  const NvdbGrid grid = NvdbGrid::open(made.file, "a.nvdb");
  EXPECT_EQ(message_of_error(ErrorKind::input, [&] { LeafTable table(grid); }),
            cat("a.nvdb: at byte ", at, ": a block's stream of ", last.stream.bytes, " bytes and kind 3 is damaged"));
}

TEST(DecodedLeaves, GridWithoutStreams_HasNoLeaves) {
  test::PackedGridOptions options;
  options.domain = {{0, 0, 0}, {200, 8, 8}};
  options.value = [](const Index3& region) { return static_cast<float>(region.x) + 3; };
  const test::PackedFile made = test::PackedGridBuilder::build(options);
  const NvdbGrid grid = NvdbGrid::open(made.file, "a.nvdb");
  const LeafTable table(grid);
  EXPECT_EQ(table.view().voxel({5, 5, 5}), 3.0F);
  EXPECT_EQ(table.view().voxel({199, 7, 7}), 4.0F);
  EXPECT_EQ(DecodedLeaves(grid).data(), nullptr);
}

TEST(DecodedLeaves, Macrocells_GatheredOfBlocks_HoldTheirValues) {
  test::PackedFile made = PackedSample::build();
  // Renames the macrocells' record, so that the file has no macrocells of its own.
  store(std::span(made.file), made.record - nvdb::kBlindMetaBytes + nvdb::blind::kName, 'x');
  const NvdbGrid grid = NvdbGrid::open(made.file, "a.nvdb");
  ASSERT_FALSE(has_macrocells(grid));
  const MacrocellGrid cells(grid, kMacrocell);
  const NodeLattice lattice = make_lattice(PackedSample::kDomain, kMacrocell);
  for_each_index(PackedSample::kDomain, [&](const Index3& i) {
    const auto cell = static_cast<std::size_t>(lattice.linear(floor_div(i, kMacrocell) - lattice.first));
    ASSERT_GE(PackedSample::value(i), cells.bounds()[cell].min);
    ASSERT_LE(PackedSample::value(i), cells.bounds()[cell].max);
  });
}

}  // namespace
}  // namespace weir::decoded_leaves_test
