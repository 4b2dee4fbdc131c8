#include "format/nanovdb/nvdb_grid.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstring>
#include <limits>
#include <vector>

#include "format/leaf/leaf_decode.h"
#include "format/nanovdb/nvdb_checksum.h"
#include "tests/stock/stock_nvdb.h"

namespace weir::nvdb_grid_test {
namespace {

using test::StockNvdb;

class StockFile : public testing::TestWithParam<GridType> {};

// Boxes of the sample grown over their nodes' edges, and boxes around the tiles' corners.
std::vector<Box> probe_boxes() {
  std::vector<Box> boxes;
  for (const Box& box : test::stock_sample_boxes())
    boxes.push_back({box.lo - Index3{9, 9, 9}, box.hi + Index3{9, 9, 9}});
  for (const Index3& corner : {Index3{64, 64, 64}, Index3{80, 72, 72}, Index3{96, 8, 8}, Index3{256, 128, 0},
                               Index3{384, 256, 128}, Index3{-8192, 4096, 0}, Index3{-4096, 8192, 4096}}) {
    boxes.push_back({corner - Index3{3, 3, 3}, corner + Index3{10, 3, 3}});
  }
  return boxes;
}

TEST_P(StockFile, ReadsTheSameValuesAndStatesAsTheStockAccessor) {
  const StockNvdb stock(GetParam());
  const auto file = stock.file();
  const NvdbGrid grid = NvdbGrid::open(file, "sample.nvdb");
  for (const Box& box : probe_boxes()) {
    for (std::int64_t n = 0; n < box.voxels(); ++n) {
      const Index3 i = box.lo + index_at(n, box.extent());
      const float expected = stock.value(i);
      ASSERT_EQ(std::bit_cast<std::uint32_t>(grid.value(i)), std::bit_cast<std::uint32_t>(expected))
          << i.x << ' ' << i.y << ' ' << i.z << ": " << grid.value(i) << " instead of " << expected;
      const GridBlock block = grid.block_at(i);
      const Index3 in = i - block.origin;
      const bool active = block.leaf != nullptr
                              ? leaf_active(block.leaf, static_cast<unsigned>(in.x << 6 | in.y << 3 | in.z))
                              : block.active;
      ASSERT_EQ(active, stock.active(i)) << i.x << ' ' << i.y << ' ' << i.z;
    }
  }
}

TEST_P(StockFile, ReadsEveryHeadFieldOfAStockFile) {
  const StockNvdb stock(GetParam());
  const auto file = stock.file();
  const NvdbGrid grid = NvdbGrid::open(file, "sample.nvdb");
  EXPECT_EQ(grid.type(), GetParam());
  EXPECT_EQ(grid.name(), "sample");
  EXPECT_EQ(grid.index_bbox(), stock.index_bbox());
  EXPECT_EQ(grid.background(), 0.25F);
  EXPECT_EQ(grid.value_min(), stock.min());
  EXPECT_EQ(grid.value_max(), stock.max());
  EXPECT_EQ(grid.voxel_size(), (std::array<double, 3>{0.5, 0.5, 0.5}));
  EXPECT_EQ(grid.world_origin(), (std::array<double, 3>{10, 20, 30}));
  EXPECT_EQ(grid.active_voxels(), stock.active_voxels());
  EXPECT_EQ(grid.root_tiles(), 15U);
  EXPECT_EQ(grid.node_counts()[2], 14U);
  EXPECT_EQ(grid.tile_counts(), (std::array<std::uint32_t, 3>{1, 1, 1}));
  EXPECT_EQ(grid.grid_offset(), 192U + 7U);
  EXPECT_EQ(grid.grid_bytes(), file.size() - grid.grid_offset());
  EXPECT_EQ(grid.data_bytes(), grid.grid_bytes());
  EXPECT_EQ(grid.head_checksum(), computed_head_checksum(grid));
  EXPECT_TRUE(grid.macrocells().cells.empty());
}

TEST_P(StockFile, WalkVisitsEveryBlockOnce) {
  const StockNvdb stock(GetParam());
  const auto file = stock.file();
  const NvdbGrid grid = NvdbGrid::open(file, "sample.nvdb");
  std::uint64_t leaves = 0;
  std::uint64_t active = 0;
  std::array<std::uint64_t, 3> active_tiles{};
  std::vector<float> values(512);
  grid.for_each_block([&](const GridBlock& block) {
    const GridBlock found = grid.block_at(block.origin + Index3{block.dim - 1, 0, block.dim - 1});
    ASSERT_EQ(found.origin, block.origin);
    ASSERT_EQ(found.dim, block.dim);
    ASSERT_EQ(found.leaf, block.leaf);
    ASSERT_EQ(found.active, block.active);
    ASSERT_EQ(found.value, block.value);
    if (block.leaf == nullptr) {
      if (block.active) ++active_tiles[block.dim == kLeafDim ? 0 : block.dim == kLowerDim ? 1 : 2];
      if (block.active) active += static_cast<std::uint64_t>(block.dim * block.dim * block.dim);
      return;
    }
    ++leaves;
    grid.decode_leaf(block.leaf, std::span<float, 512>(values));
    for (unsigned n = 0; n < 512; ++n) {
      active += leaf_active(block.leaf, n) ? 1 : 0;
      const Index3 i = block.origin + Index3{n >> 6U, n >> 3U & 7U, n & 7U};
      ASSERT_EQ(values[n], stock.value(i));
    }
  });
  EXPECT_EQ(leaves, grid.node_counts()[0]);
  EXPECT_EQ(active, stock.active_voxels());
  EXPECT_EQ(active_tiles, (std::array<std::uint64_t, 3>{1, 1, 1}));
}

TEST_P(StockFile, ReadsTheSameAtAnyAlignmentInMemory) {
  const StockNvdb stock(GetParam());
  const auto file = stock.file();
  for (std::size_t shift = 1; shift < 8; shift += 3) {
    std::vector<std::byte> moved(file.size() + shift);
    std::memcpy(moved.data() + shift, file.data(), file.size());
    const NvdbGrid grid = NvdbGrid::open(std::span(moved).subspan(shift), "sample.nvdb");
    for (const Index3& i : {Index3{0, 0, 0}, Index3{-13, -5, -9}, Index3{4100, 4003, 1}, Index3{97, 9, 9}}) {
      EXPECT_EQ(grid.value(i), stock.value(i));
    }
  }
}

TEST_P(StockFile, IgnoresPaddingAtTheTailOfTheGrid) {
  const StockNvdb stock(GetParam());
  auto file = stock.file();
  const NvdbGrid before = NvdbGrid::open(file, "sample.nvdb");
  const std::uint64_t padded = before.grid_bytes() + 12345;
  const std::uint64_t data = before.data_bytes();
  const std::uint64_t grid_offset = before.grid_offset();
  file.resize(file.size() + 12345);
  for (const std::uint64_t field :
       {nvdb::meta::kGridSize, nvdb::meta::kFileSize, grid_offset + nvdb::grid::kGridSize}) {
    std::memcpy(file.data() + field, &padded, sizeof padded);
  }
  const NvdbGrid grid = NvdbGrid::open(file, "sample.nvdb");
  EXPECT_EQ(grid.grid_bytes(), padded);
  EXPECT_EQ(grid.data_bytes(), data);
  EXPECT_EQ(grid.data().size(), data);
  EXPECT_EQ(grid.value({1, 2, 3}), stock.value({1, 2, 3}));
}

INSTANTIATE_TEST_SUITE_P(AllTypes, StockFile,
                         testing::Values(GridType::float32, GridType::fp4, GridType::fp8, GridType::fp16,
                                         GridType::fpn),
                         [](const auto& parameter) { return std::string(grid_type_name(parameter.param)); });

TEST(NvdbGrid, FirstOfTwoGridsInASegment) {
  const StockNvdb stock(GridType::float32);
  const auto file = stock.file_of_two();
  const NvdbGrid grid = NvdbGrid::open(file, "two.nvdb");
  EXPECT_EQ(grid.name(), "sample");
  EXPECT_EQ(grid.grid_offset(), 16U + 2 * 176 + 2 * 7);
  EXPECT_EQ(grid.value({2, 3, 4}), stock.value({2, 3, 4}));
}

TEST(NvdbGrid, CoordinatesBeyond32BitsAreBackground) {
  const StockNvdb stock(GridType::float32);
  const auto file = stock.file();
  const NvdbGrid grid = NvdbGrid::open(file, "sample.nvdb");
  // The key of a root tile would wrap to the tile at the origin.
  EXPECT_EQ(grid.value({std::int64_t{1} << 32U, 0, 0}), 0.25F);
  EXPECT_EQ(grid.value({0, std::numeric_limits<std::int64_t>::min() / 2, 0}), 0.25F);
  EXPECT_EQ(grid.block_at({std::int64_t{1} << 32U, 0, 0}).origin, (Index3{std::int64_t{1} << 32U, 0, 0}));
}

}  // namespace
}  // namespace weir::nvdb_grid_test
