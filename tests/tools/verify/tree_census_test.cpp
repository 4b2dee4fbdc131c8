#include "tools/verify/tree_census.h"

#include <gtest/gtest.h>

#include <numeric>

#include "tests/tools/support/converted_volume.h"

namespace weir::tree_census_test {
namespace {

using TreeCensusTest = ConvertedVolume;

TEST_F(TreeCensusTest, CountsLeavesTilesAndVoxels) {
  const NvdbFile file = open();
  const TreeCensus census = take_census(file.grid(), {});
  EXPECT_EQ(census.leaves + census.active_tiles[0] + census.inactive_tiles[0], 4096U);  // one lower node
  EXPECT_EQ(census.leaves_by_bits, (std::array<std::uint64_t, 6>{0, 0, 0, 0, 0, census.leaves}));
  EXPECT_EQ(census.active_voxels, file.grid().active_voxels());
  EXPECT_GT(census.inactive_tiles[0], 4096U - 5 * 4 * 3);
  EXPECT_EQ(census.active_bbox, (Box{{0, 0, 0}, {40, 30, 20}}));
  EXPECT_EQ(census.min, 0.0F);
  EXPECT_EQ(census.max, file.grid().value_max());
  EXPECT_EQ(census.nonfinite, 0U);
  std::uint64_t zeros = 0;
  for (int i = 0; i < 40 * 30 * 20; ++i) zeros += i % 40 < 20 || i % 997 == 0 ? 1 : 0;
  ASSERT_EQ(file.grid().background(), 0.0F);
  EXPECT_EQ(census.valued_voxels + census.quiet_voxels, 40U * 30 * 20);
  EXPECT_EQ(census.zeros + census.quiet_voxels, zeros);
  EXPECT_EQ(census.backgrounds, census.zeros);
  const auto counts = count_values(file.grid(), census.min, census.max, 10, {});
  EXPECT_EQ(std::accumulate(counts.begin(), counts.end(), std::uint64_t{0}), census.active_voxels);
}

}  // namespace
}  // namespace weir::tree_census_test
