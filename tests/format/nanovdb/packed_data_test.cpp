// Packed data as NvdbGrid shows it: look-up, blocks and values.
#include "format/nanovdb/packed_data.h"

#include <gtest/gtest.h>

#include <bit>

#include "format/nanovdb/nvdb_grid.h"
#include "format/nanovdb/read_box.h"
#include "tests/support/packed_sample.h"

namespace weir::packed_data_test {
namespace {

using test::PackedSample;

constexpr Box kDomain = PackedSample::kDomain;

float expected(const Index3& i) { return PackedSample::value(i); }

class PackedDataTest : public testing::Test {
 protected:
  test::PackedFile made_ = PackedSample::build();
  NvdbGrid grid_ = NvdbGrid::open(made_.file, "a.nvdb");
};

TEST_F(PackedDataTest, Open_PackedGrid_ShowsHeaderAndDomain) {
  ASSERT_NE(grid_.packed(), nullptr);
  EXPECT_EQ(grid_.index_bbox(), kDomain);
  EXPECT_EQ(grid_.packed()->regions().first, (Index3{-1, 0, 0}));
  EXPECT_EQ(grid_.packed()->regions().count, (Index3{4, 1, 1}));
  EXPECT_FALSE(grid_.packed()->header().preview);
  EXPECT_EQ(grid_.packed()->region({1, 0, 0}).chunk, 0U);
  EXPECT_EQ(grid_.packed()->region({1, 0, 0}).value, 0.125F);
  EXPECT_EQ(grid_.data_bytes(), grid_.grid_bytes());
}

TEST_F(PackedDataTest, Value_InAndOutsideTheDomain_IsThatOfTheStreams) {
  for_each_index(grown({kDomain.lo, {30, 40, 61}}, 2),
                 [&](const Index3& i) { ASSERT_EQ(grid_.value(i), expected(i)) << i.x << ' ' << i.y << ' ' << i.z; });
  EXPECT_EQ(grid_.value({200, 20, 20}), expected({200, 20, 20}));
  EXPECT_EQ(grid_.value({std::int64_t{1} << 40U, 0, 0}), PackedSample::kBackground);
}

TEST_F(PackedDataTest, ReadBox_OverhangingTheDomain_IsWhatValueSays) {
  for (const Box& box : {grown(kDomain, 3), Box{{100, 5, 12}, {131, 23, 50}}, Box{{300, 0, 0}, {310, 9, 9}}}) {
    std::vector<float> values(static_cast<std::size_t>(box.voxels()), -7.0F);
    read_box(grid_, box, values);
    std::size_t next = 0;
    for_each_index(box, [&](const Index3& i) { ASSERT_EQ(values[next++], expected(i)) << i.x << ' ' << i.y; });
  }
}

TEST_F(PackedDataTest, ForEachBlock_CoversTheDomainOnce) {
  std::int64_t voxels = 0;
  std::uint64_t coded = 0;
  std::array<float, kLeafVoxels> values;
  grid_.for_each_block([&](const GridBlock& block) {
    const Box box{block.origin, block.origin + Index3{block.dim, block.dim, block.dim}};
    const Box inside = intersect(box, kDomain);
    ASSERT_FALSE(inside.empty());
    voxels += inside.voxels();
    EXPECT_TRUE(block.active);
    EXPECT_EQ(block.leaf, nullptr);
    const GridBlock found = grid_.block_at(inside.lo);
    EXPECT_EQ(found.origin, block.origin);
    EXPECT_EQ(found.dim, block.dim);
    EXPECT_EQ(found.stream.data, block.stream.data);
    EXPECT_EQ(found.stream.bytes, block.stream.bytes);
    EXPECT_EQ(std::bit_cast<std::uint32_t>(found.value), std::bit_cast<std::uint32_t>(block.value));
    coded += block.coded() ? 1 : 0;
    EXPECT_EQ(block.dim, floor_div(block.origin.x, kLowerDim) == 0 ? kLowerDim : kLeafDim);
    if (block.dim != kLeafDim) return;
    grid_.decode_block(block, values);
    for_each_index(inside, [&](const Index3& i) {
      const Index3 in = i - block.origin;
      ASSERT_EQ(values[static_cast<std::size_t>(in.x << 6 | in.y << 3 | in.z)], expected(i));
    });
  });
  EXPECT_EQ(voxels, kDomain.voxels());
  EXPECT_GT(coded, 0U);
}

TEST_F(PackedDataTest, ForEachTreeBlock_PackedGrid_ShowsTheTree) {
  std::uint64_t blocks = 0;
  grid_.for_each_tree_block([&](const GridBlock& block) {
    ++blocks;
    EXPECT_EQ(block.dim, kUpperDim);
    EXPECT_FALSE(block.active);
  });
  EXPECT_EQ(blocks, 2U);
}

TEST_F(PackedDataTest, BlockAt_OutsideTheRegions_IsBackground) {
  const GridBlock block = grid_.block_at({-200, 5, 300});
  EXPECT_EQ(block.origin, (Index3{-256, 0, 256}));
  EXPECT_EQ(block.dim, kLowerDim);
  EXPECT_FALSE(block.active);
  EXPECT_FALSE(block.coded());
  EXPECT_EQ(block.value, PackedSample::kBackground);
}

TEST(PackedData, MeanStream_DecodesToTheLowestMean) {
  test::PackedGridOptions options;
  options.domain = {{0, 0, 0}, {8, 8, 8}};
  options.means = {2.5F, 2.5F};  // of one code: 1 bit
  options.stream = [](const Index3&) { return test::mean_stream(0, 1); };
  const auto made = test::PackedGridBuilder::build(options);
  EXPECT_EQ(NvdbGrid::open(made.file, "a.nvdb").value({3, 4, 5}), 2.5F);
}

TEST(PackedData, PackedPosition_Inverse) {
  for (unsigned p = 0; p < 4096; ++p) EXPECT_EQ(packed_position(packed_block(p)), p);
  EXPECT_EQ(packed_position({-1, 17, 2}), 15U << 8U | 1U << 4U | 2U);
}

}  // namespace
}  // namespace weir::packed_data_test
