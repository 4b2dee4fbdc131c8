// The sampled blocks of a volume: their number, their places, and that has() and rows() agree.
#include "compressor/packed/block_sample.h"

#include <gtest/gtest.h>

#include <set>

namespace weir::block_sample_test {
namespace {

NodeLattice lattice_of(const Index3& voxels) { return make_lattice({{-3, 5, 8}, Index3{-3, 5, 8} + voxels}, kLeafDim); }

TEST(BlockSample, RowsHoldTheBlocksThatItHas) {
  for (const Index3& extent : {Index3{512, 512, 512}, Index3{70, 400, 900}, Index3{4100, 64, 72}, Index3{8, 8, 8},
                               Index3{100000, 9, 9}, Index3{9, 9, 100000}}) {
    const NodeLattice leaves = lattice_of(extent);
    const BlockSample sample(leaves);
    std::set<std::int64_t> in_rows;
    for (const Box& row : sample.rows()) {
      EXPECT_EQ(row.extent().y * row.extent().z, 1);
      EXPECT_LE(row.extent().x, 256);
      for (std::int64_t x = row.lo.x; x < row.hi.x; ++x) {
        EXPECT_TRUE(in_rows.insert(leaves.linear({x, row.lo.y, row.lo.z})).second);
      }
    }
    std::int64_t count = 0;
    for (std::int64_t i = 0; i < leaves.size(); ++i) {
      const bool has = sample.has(leaves.position(i));
      count += has ? 1 : 0;
      ASSERT_EQ(has, in_rows.contains(i)) << i;
    }
    EXPECT_EQ(count, sample.size());
  }
}

TEST(BlockSample, IsAllOfASmallVolumeAndASmallPartOfALargeOne) {
  EXPECT_EQ(BlockSample(lattice_of({60, 70, 80})).size(), lattice_of({60, 70, 80}).size());
  EXPECT_EQ(BlockSample(make_lattice({{0, 0, 0}, {512, 512, 512}}, kLeafDim)).size(), 4096);  // one in 64
  EXPECT_EQ(BlockSample(make_lattice({{0, 0, 0}, {2048, 2048, 2048}}, kLeafDim)).size(), 8192);
}

// A few long rows of a sparse volume may hold anything, so a long volume needs many rows.
TEST(BlockSample, HasManyRowsOfALongVolume) {
  EXPECT_GE(BlockSample(make_lattice({{0, 0, 0}, {8 * 65, 320, 200}}, kLeafDim)).size(), 1000);
  EXPECT_GE(BlockSample(make_lattice({{0, 0, 0}, {8 * 129, 320, 200}}, kLeafDim)).size(), 1000);
  EXPECT_EQ(BlockSample(make_lattice({{0, 0, 0}, {768, 768, 768}}, kLeafDim)).rows().size(), 171U);
  EXPECT_EQ(BlockSample(make_lattice({{0, 0, 0}, {8192, 512, 512}}, kLeafDim)).rows().size(), 128U);
}

TEST(BlockSample, RowsLieInAllPartsOfTheVolume) {
  const NodeLattice leaves = make_lattice({{0, 0, 0}, {512, 512, 512}}, kLeafDim);
  std::set<std::int64_t> y;
  std::set<std::int64_t> z;
  for (const Box& row : BlockSample(leaves).rows()) {
    y.insert(row.lo.y / 8);
    z.insert(row.lo.z);
  }
  EXPECT_EQ(y.size(), 8U);
  EXPECT_EQ(z.size(), 64U);
}

}  // namespace
}  // namespace weir::block_sample_test
