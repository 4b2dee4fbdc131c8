#include "format/nanovdb/nvdb_header.h"

#include <gtest/gtest.h>

#include <cstring>

#include "format/base/error.h"
#include "format/nanovdb/nvdb_grid.h"
#include "tests/stock/stock_nvdb.h"

namespace weir::nvdb_header_test {
namespace {

TEST(NvdbHeader, FindsTheGridsOfEverySegment) {
  const test::StockNvdb stock(GridType::float32);
  auto bytes = stock.file_of_two();
  const std::size_t first_segment = bytes.size();
  const auto more = stock.file();
  bytes.insert(bytes.end(), more.begin(), more.end());

  EXPECT_EQ(first_nvdb_segment(bytes, "a").size(), 2U);
  const auto records = all_nvdb_segments(bytes, "a");
  ASSERT_EQ(records.size(), 3U);
  EXPECT_EQ(nvdb_grid_name(bytes, records[0]), "sample");
  EXPECT_EQ(nvdb_grid_name(bytes, records[1]), "second");
  EXPECT_EQ(nvdb_grid_name(bytes, records[2]), "sample");
  EXPECT_EQ(records[2].segment, first_segment);
  EXPECT_EQ(NvdbGrid::open(bytes, "a", records[1]).value({1, 2, 3}), 4.0F);
  EXPECT_EQ(NvdbGrid::open(bytes, "a", records[2]).index_bbox(), stock.index_bbox());
}

TEST(NvdbHeader, KeepsTheMatrixOfTheMap) {
  const auto bytes = test::StockNvdb(GridType::float32).file();
  const NvdbHeader header = read_nvdb_header(bytes, "a", first_nvdb_segment(bytes, "a").front());
  EXPECT_EQ(header.matrix, (std::array<double, 9>{0.5, 0, 0, 0, 0.5, 0, 0, 0, 0.5}));
  EXPECT_EQ(header.world_origin, (std::array<double, 3>{10, 20, 30}));
}

TEST(NvdbHeader, BytesAfterTheLastSegmentAreRefused) {
  auto bytes = test::StockNvdb(GridType::fp4).file();
  const std::size_t end = bytes.size();
  bytes.resize(end + 16, std::byte{'x'});
  try {
    all_nvdb_segments(bytes, "a");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.what(), "a: at byte " + std::to_string(end) +
                                ": magic number 0x7878787878787878 is not NanoVDB0 or NanoVDB2; not a NanoVDB file");
  }
}

TEST(NvdbHeader, GridBeyondTheFileEndIsTheLastOneListed) {
  auto bytes = test::StockNvdb(GridType::float32).file();
  const std::uint64_t huge = ~std::uint64_t{0} - 7;
  std::memcpy(bytes.data() + 24, &huge, sizeof huge);  // the grid's bytes in the file
  EXPECT_EQ(all_nvdb_segments(bytes, "a").size(), 1U);
}

}  // namespace
}  // namespace weir::nvdb_header_test
