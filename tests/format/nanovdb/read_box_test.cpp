#include "format/nanovdb/read_box.h"

#include <gtest/gtest.h>

#include <bit>
#include <vector>

#include "tests/stock/stock_nvdb.h"

namespace weir::read_box_test {
namespace {

class ReadBox : public testing::TestWithParam<GridType> {};

TEST_P(ReadBox, ReadsWhatTheStockAccessorReads) {
  const test::StockNvdb stock(GetParam());
  const auto file = stock.file();
  const NvdbGrid grid = NvdbGrid::open(file, "sample.nvdb");
  std::vector<Box> boxes{{{64, 64, 64}, {65, 65, 65}}, {{-8195, 4090, -3}, {-8180, 4099, 5}}};
  for (const Box& box : test::stock_sample_boxes()) {
    boxes.push_back(grown(box, 9));
    boxes.push_back({box.lo + Index3{1, 0, 1}, box.hi});
  }
  for (const Box& box : boxes) {
    std::vector<float> values(static_cast<std::size_t>(box.voxels()), -1.0F);
    read_box(grid, box, values);
    std::size_t next = 0;
    for_each_index(box, [&](const Index3& i) {
      ASSERT_EQ(std::bit_cast<std::uint32_t>(values[next++]), std::bit_cast<std::uint32_t>(stock.value(i)))
          << i.x << ' ' << i.y << ' ' << i.z;
    });
  }
  read_box(grid, {{3, 3, 3}, {3, 4, 4}}, {});
}

INSTANTIATE_TEST_SUITE_P(Types, ReadBox, testing::Values(GridType::float32, GridType::fp8, GridType::fpn));

}  // namespace
}  // namespace weir::read_box_test
