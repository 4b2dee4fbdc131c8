#include "compressor/forecast/sample_axis.h"

#include <gtest/gtest.h>

#include <set>
#include <vector>

namespace weir::sample_axis_test {
namespace {

TEST(SampleAxis, Rows_AreCutIntoEqualCellsOfAtMostTheLongest) {
  const SampleAxis axis(0, 1000, 0, 0, 64, 1);
  EXPECT_TRUE(axis.whole());
  EXPECT_EQ(axis.cell(), 62 * 8);  // 125 leaves in two parts
  EXPECT_EQ(axis.taken(), 2);
  EXPECT_EQ(axis.voxels(), 1000);
}

TEST(SampleAxis, Shorter_TakesWholeLowerNodesAndThenHalves) {
  SampleAxis axis(0, 1000, 0, 0, 1, 1);
  std::vector<std::int64_t> taken;
  while (axis.taken() > 1) {
    axis.take_fewer();
    taken.push_back(axis.taken());
  }
  EXPECT_EQ(taken, (std::vector<std::int64_t>{112, 96, 80, 64, 48, 32, 16, 8, 4, 2, 1}));
}

TEST(SampleAxis, Cells_BeginOnLeavesInsideTheDomain) {
  SampleAxis axis(-13, 300, 0, 0, 1, 1);
  axis.take_fewer();
  ASSERT_EQ(axis.taken(), 32);
  for (std::int64_t stratum = 0; stratum < axis.taken(); ++stratum) {
    for (const double fraction : {0.0, 0.5, 0.999999}) {
      const std::int64_t at = axis.begin(stratum, fraction);
      EXPECT_EQ(at % 8, 0);
      EXPECT_GE(at, -8);
      EXPECT_LE(at + 8, 300);
    }
  }
}

TEST(SampleAxis, EveryCellIsAsLikelyAsAnother) {
  SampleAxis axis(0, 8 * 48, 0, 0, 1, 1);
  axis.take_fewer();
  ASSERT_EQ(axis.taken(), 32);  // of 48
  std::vector<int> drawn(48);
  constexpr int kFractions = 300;
  for (std::int64_t stratum = 0; stratum < 32; ++stratum) {
    for (int i = 0; i < kFractions; ++i) {
      ++drawn[static_cast<std::size_t>(axis.begin(stratum, (i + 0.5) / kFractions) / 8)];
    }
  }
  for (const int count : drawn) EXPECT_EQ(count, kFractions * 32 / 48);
}

TEST(SampleAxis, Chunks_AreWhole) {
  SampleAxis axis(10, 1010, 48, 16, 1, 1);  // chunks at 16, 64, ...
  EXPECT_EQ(axis.cell(), 48);
  EXPECT_EQ(axis.taken(), 20);
  axis.take_fewer();
  EXPECT_EQ(axis.taken(), 16);  // 768 voxels, six lower nodes
  std::set<std::int64_t> edges;
  for (std::int64_t stratum = 0; stratum < 16; ++stratum) edges.insert((axis.begin(stratum, 0.3) - 16) % 48);
  EXPECT_EQ(edges, std::set<std::int64_t>{0});
}

TEST(SampleAxis, ChunksThatNoLeafEndsWith_AreCutAsRows) {
  const SampleAxis axis(0, 1000, 50, 3, 1, 1);
  EXPECT_EQ(axis.cell() % 8, 0);
  EXPECT_GE(axis.cell(), 50);
}

TEST(SampleAxis, LessThanACell_IsWhole) {
  const SampleAxis thin(0, 5, 0, 0, 1, 1);
  EXPECT_TRUE(thin.whole());
  EXPECT_EQ(thin.voxels(), 5);
  const SampleAxis chunk(0, 100, 128, 0, 1, 1);
  EXPECT_TRUE(chunk.whole());
  EXPECT_EQ(chunk.voxels(), 100);
}

}  // namespace
}  // namespace weir::sample_axis_test
