#include "gpu/volume/voxel_memory.h"

#include <gtest/gtest.h>

#include "format/base/error.h"
#include "gpu/volume/cached_blocks.h"
#include "gpu/volume/macrocell_grid.h"
#include "tests/stock/test_grid.h"
#include "tests/support/message_of_error.h"
#include "tests/support/packed_sample.h"

namespace weir::voxel_memory_test {
namespace {

using test::PackedSample;

constexpr std::uint64_t kKiB = 1024;

class VoxelMemoryOfPackedGrid : public testing::Test {
 protected:
  test::PackedFile made_ = PackedSample::build();
  NvdbGrid grid_ = NvdbGrid::open(made_.file, "a.nvdb");
};

TEST_F(VoxelMemoryOfPackedGrid, WithoutACeiling_AllBlocksAreDecoded) {
  EXPECT_EQ(plan_voxels(grid_, {}).cache_bytes, std::nullopt);
}

TEST_F(VoxelMemoryOfPackedGrid, CeilingThatHoldsAllBlocks_DecodesThem) {
  const auto kinds = PackedSample::blocks_by_kind();
  const std::uint64_t decoded = (kinds[0] + kinds[1]) * nvdb::kFloatLeafBytes;
  const std::uint64_t fixed = plan_voxels(grid_, {}).fixed_bytes;
  EXPECT_EQ(plan_voxels(grid_, {fixed + decoded}).cache_bytes, std::nullopt);
  const VoxelPlan less = plan_voxels(grid_, {fixed + decoded - 1});
  EXPECT_EQ(less.cache_bytes, decoded - 1);
  EXPECT_EQ(less.decoded_bytes, decoded);
}

TEST_F(VoxelMemoryOfPackedGrid, TableMacrocellsAndCache_StayUnderTheCeiling) {
  const std::uint64_t ceiling = 600 * kKiB;
  const VoxelPlan plan = plan_voxels(grid_, {ceiling});
  ASSERT_TRUE(plan.cache_bytes);
  const CachedBlocks blocks(grid_, *plan.cache_bytes);
  const std::uint64_t bytes = blocks.bytes() + MacrocellGrid(grid_, kMacrocell).bytes();
  EXPECT_LE(bytes, ceiling);
  EXPECT_GT(bytes, ceiling - BlockCache::kWays * BlockCache::kBlockBytes);
}

TEST_F(VoxelMemoryOfPackedGrid, VolumesOfASeries_ShareTheCeiling) {
  const std::uint64_t ceiling = 600 * kKiB;
  EXPECT_EQ(plan_voxels(grid_, {2 * ceiling, 2}).cache_bytes, plan_voxels(grid_, {ceiling}).cache_bytes);
}

TEST_F(VoxelMemoryOfPackedGrid, CeilingBelowTableAndLeastCache_IsRefused) {
  EXPECT_EQ(
      message_of_error(ErrorKind::usage, [&] { plan_voxels(grid_, {500 * kKiB}); }),
      "--memory 500.0 KiB is too small to render this grid, which takes 519.2 KiB at least; give --memory 1MiB or "
      "more");
  EXPECT_EQ(
      message_of_error(ErrorKind::usage,
                       [&] {
                         plan_voxels(grid_, {1000 * kKiB, 2});
                       }),
      "--memory 1000.0 KiB is too small to render this grid, which takes 519.2 KiB at least, 2 volumes of a series "
      "being held at a time; give --memory 2MiB or more");
}

TEST(VoxelMemory, BlocksSmallerThanTheLeastCache_AreDecodedWhereTheyFit) {
  test::PackedGridOptions options;
  options.domain = {{0, 0, 0}, {16, 8, 8}};
  options.stream = [](const Index3&) { return test::constant_stream(2); };
  const test::PackedFile made = test::PackedGridBuilder::build(options);
  const NvdbGrid grid = NvdbGrid::open(made.file, "a.nvdb");
  const std::uint64_t decoded = plan_voxels(grid, {}).fixed_bytes + 2 * nvdb::kFloatLeafBytes;
  ASSERT_LT(decoded, kLeastCacheBytes);
  EXPECT_EQ(plan_voxels(grid, {decoded}).cache_bytes, std::nullopt);
  EXPECT_THROW(plan_voxels(grid, {decoded - 1}), Error);
}

TEST(VoxelMemory, GridThatIsNotPacked_NeedsItsTableAndMacrocells) {
  const test::TestGrid grid({{0, 0, 0}, {160, 160, 160}}, [](const Index3& i) { return static_cast<float>(i.x); });
  const std::uint64_t fixed = plan_voxels(grid.grid(), {1024 * kKiB}).fixed_bytes;
  EXPECT_GE(fixed, LeafTable(grid.grid()).bytes() + MacrocellGrid(grid.grid(), kMacrocell).bytes());
  EXPECT_EQ(plan_voxels(grid.grid(), {fixed}).cache_bytes, std::nullopt);
  EXPECT_EQ(message_of_error(ErrorKind::usage, [&] { plan_voxels(grid.grid(), {fixed - 1}); }),
            cat("--memory ", format_bytes(fixed - 1), " is too small to render this grid, which takes ",
                format_bytes(fixed), " at least; give --memory 1MiB or more"));
}

}  // namespace
}  // namespace weir::voxel_memory_test
