#include "gpu/volume/leaf_table.h"

#include <gtest/gtest.h>

#include <cmath>

#include "format/base/error.h"
#include "tests/stock/test_grid.h"

namespace weir::leaf_table_test {
namespace {

using test::TestGrid;
using test::TestGridOptions;
using test::TestTile;

float wave(const Index3& i) {
  return std::sin(0.37F * static_cast<float>(i.x)) + 0.25F * std::cos(0.11F * static_cast<float>(i.y * i.z)) +
         0.01F * static_cast<float>(i.z);
}

// Checks that the table gives the same as the grid's reader for every voxel of the domain.
void expect_equal(const NvdbGrid& grid, std::int64_t stride = 1) {
  const LeafTable table(grid);
  const LeafTableView view = table.view();
  const Box& domain = table.domain();
  EXPECT_EQ(domain, grid.index_bbox());
  std::int64_t checked = 0;
  for (std::int64_t z = domain.lo.z; z < domain.hi.z; z += stride) {
    for (std::int64_t y = domain.lo.y; y < domain.hi.y; y += stride) {
      for (std::int64_t x = domain.lo.x; x < domain.hi.x; x += stride) {
        const Index3 local = Index3{x, y, z} - domain.lo;
        const Int3 i{static_cast<std::int32_t>(local.x), static_cast<std::int32_t>(local.y),
                     static_cast<std::int32_t>(local.z)};
        ASSERT_EQ(view.voxel(i), grid.value({x, y, z})) << x << ' ' << y << ' ' << z;
        ++checked;
      }
    }
  }
  EXPECT_GT(checked, 0);
}

class LeafTableOfType : public testing::TestWithParam<GridType> {};

TEST_P(LeafTableOfType, SameValuesAsTheReader) {
  TestGridOptions options;
  options.type = GetParam();
  options.background = 0.25F;
  options.tiles = {{{40, 8, 0}, 8, 3.5F, true}, {{-24, 8, 0}, 8, -2, false}};
  expect_equal(TestGrid({{-21, -5, 3}, {38, 30, 27}}, wave, options).grid());
}

INSTANTIATE_TEST_SUITE_P(AllTypes, LeafTableOfType,
                         testing::Values(GridType::float32, GridType::fp4, GridType::fp8, GridType::fp16,
                                         GridType::fpn),
                         [](const auto& of) { return std::string(grid_type_name(of.param)); });

TEST(LeafTable, TilesOfEverySize) {
  TestGridOptions options;
  options.background = -1;
  options.tiles = {{{0, 0, 0}, 8, 1, true}, {{128, 0, 0}, 128, 2, true}, {{4096, 0, 0}, 4096, 3, true}};
  expect_equal(TestGrid({}, wave, options).grid(), 61);
}

TEST(LeafTable, NothingButTiles) {
  TestGridOptions options;
  options.tiles = {{{8, 16, 24}, 8, 5, true}, {{16, 16, 24}, 8, 6, true}};
  const TestGrid grid({}, wave, options);
  const LeafTable table(grid.grid());
  EXPECT_EQ(table.view().extent, (Int3{16, 8, 8}));
  EXPECT_EQ(table.view().leaves, nullptr);
  EXPECT_EQ(table.view().voxel({0, 0, 0}), 5.0F);
  EXPECT_EQ(table.view().voxel({15, 7, 7}), 6.0F);
}

TEST(LeafTable, OneVoxel) {
  const TestGrid grid({{7, -9, 4095}, {8, -8, 4096}}, [](const Index3&) { return 42.0F; });
  const LeafTable table(grid.grid());
  EXPECT_EQ(table.view().extent, (Int3{1, 1, 1}));
  EXPECT_EQ(table.view().count, (Int3{1, 1, 1}));
  EXPECT_EQ(table.view().shift, (Int3{7, 7, 7}));
  EXPECT_EQ(table.view().voxel({0, 0, 0}), 42.0F);
}

// A needle that is longer than an upper node and one voxel thick.
TEST(LeafTable, NeedleLongerThanAnUpperNode) {
  const TestGrid grid({{3, 5, -10}, {4, 6, 4200}}, wave);
  expect_equal(grid.grid());
}

TEST(LeafTable, ExtentsAbove4096FarApart) {
  TestGridOptions options;
  options.background = 9;
  options.tiles = {{{-4096, 0, 0}, 8, 1, true}, {{5000 / 8 * 8, 128, 0}, 8, 2, true}};
  const TestGrid grid({}, wave, options);
  const LeafTable table(grid.grid());
  EXPECT_EQ(table.view().extent, (Int3{9104, 136, 8}));
  EXPECT_EQ(table.view().voxel({0, 0, 0}), 1.0F);
  EXPECT_EQ(table.view().voxel({4096, 64, 4}), 9.0F);
  EXPECT_EQ(table.view().voxel({9103, 135, 7}), 2.0F);
}

TEST(LeafTable, BoxTooLargeIsAnError) {
  TestGridOptions options;
  options.tiles = {{{-100000 * 8, 0, 0}, 8, 1, true}, {{0, 50000 * 8, 90000 * 8}, 8, 2, true}};
  const TestGrid grid({}, wave, options);
  try {
    const LeafTable table(grid.grid());
    FAIL() << "a table of " << table.bytes() << " bytes";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    EXPECT_STREQ(error.what(),
                 "the grid's bounding box is 800008 x 400008 x 720008 voxels, more than 2^31 blocks of 8^3; convert a "
                 "part of it with --roi");
  }
}

TEST(LeafTable, EmptyGridIsAnError) {
  const TestGrid grid({}, wave);
  EXPECT_THROW(LeafTable{grid.grid()}, Error);
}

}  // namespace
}  // namespace weir::leaf_table_test
