#include "ingest/plan/block_axis.h"

#include <gtest/gtest.h>

#include <limits>

namespace weir::block_axis_test {
namespace {

constexpr std::int64_t kAll = std::numeric_limits<std::int64_t>::max();

TEST(BlockAxis, UnitAlignsBlocksWithLeavesAndChunks) {
  EXPECT_EQ(BlockAxis(0, 1000, 0, 0).unit, 1);
  EXPECT_EQ(BlockAxis(0, 1000, 1, 0).unit, 1);
  EXPECT_EQ(BlockAxis(0, 1000, 64, 0).unit, 8);
  EXPECT_EQ(BlockAxis(0, 1000, 100, 0).unit, 25);
  EXPECT_EQ(BlockAxis(0, 1000, 75, 0).unit, 75);
  EXPECT_EQ(BlockAxis(0, 1000, 999, 0).unit, 125) << "no longer than the axis";
  EXPECT_EQ(BlockAxis(0, 1000, 64, 4).unit, 1) << "chunk edges are off leaf edges";
}

TEST(BlockAxis, AmplificationCountsChunksThatBlocksShare) {
  BlockAxis axis(0, 512, 64, 0);
  EXPECT_EQ(axis.amplification(kAll), 1);
  axis.size = 1;
  EXPECT_EQ(axis.amplification(kAll), 8);
  axis.size = 12;  // blocks end at 96, 192, ...: every other end cuts a chunk
  EXPECT_EQ(axis.amplification(kAll), 11.0 / 8);
  EXPECT_EQ(axis.amplification(2), 4.0 / 3) << "96 voxels of two and 96 of two, of the first three";
  axis.size = axis.count;
  EXPECT_EQ(axis.amplification(kAll), 1);
  EXPECT_EQ(BlockAxis(0, 512, 0, 0).amplification(kAll), 1);
}

TEST(BlockAxis, UsefulCutsGetLongerAndBetter) {
  for (const std::int64_t chunk : {0, 1, 8, 64, 75, 100, 1000}) {
    for (const std::int64_t edge : {0, 3, -64}) {
      const BlockAxis axis(-20, 777, chunk, edge);
      const std::vector<AxisCut> cuts = useful_cuts(axis);
      ASSERT_FALSE(cuts.empty());
      EXPECT_EQ(cuts.back().amplification, 1) << chunk << ' ' << edge;
      for (std::size_t i = 1; i < cuts.size(); ++i) {
        EXPECT_GT(cuts[i].longest, cuts[i - 1].longest);
        EXPECT_LT(cuts[i].amplification, cuts[i - 1].amplification);
      }
      for (const AxisCut& cut : cuts) {
        BlockAxis cut_axis = axis;
        cut_axis.size = cut.size;
        EXPECT_EQ(cut_axis.amplification(kAll), cut.amplification);
        EXPECT_EQ(cut_axis.longest(), cut.longest);
      }
    }
  }
  const std::vector<AxisCut> cubes = useful_cuts(BlockAxis(0, 512, 64, 0));
  EXPECT_EQ(cubes.size(), 5U);  // blocks of 1, 2, 3 and 4 eighths of a chunk, and of a whole chunk
  EXPECT_EQ(cubes.back().size, 8);
}

}  // namespace
}  // namespace weir::block_axis_test
