#include "gpu/cuda/expand/expanded_grid.h"

#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

#include "format/base/error.h"
#include "tests/cuda/support/device_reads.h"
#include "tests/gpu/expand/host_expansion.h"
#include "tests/stock/test_grid.h"
#include "tests/support/message_of_error.h"
#include "tests/support/packed_kinds.h"
#include "tests/support/packed_sample.h"
#include "tests/support/temporary_directory.h"

namespace weir::expanded_grid_test {
namespace {

class ExpandedGridTest : public testing::Test {
 protected:
  void SetUp() override { WEIR_NEEDS_DEVICE(); }

  NvdbFile file(std::span<const std::byte> bytes) const {
    std::ofstream(path_, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    return NvdbFile(path_);
  }

  TemporaryDirectory directory_;
  std::string path_ = directory_ / "a.nvdb";
};

std::vector<std::byte> bytes_of(const DeviceGrid& grid) {
  std::vector<std::byte> bytes(grid.bytes());
  EXPECT_EQ(cudaMemcpy(bytes.data(), grid.data(), bytes.size(), cudaMemcpyDeviceToHost), cudaSuccess);
  return bytes;
}

TEST_F(ExpandedGridTest, HasTheBytesThatTheHostMakes) {
  DeviceBuffer buffer;
  for (const test::PackedFile& made : {test::PackedSample::build(), test::build_packed_kinds()}) {
    const NvdbFile packed = file(made.file);
    for (const GridType type : {GridType::float32, GridType::fp16}) {
      DeviceGrid grid = load_grid_as(packed, type, std::move(buffer));
      EXPECT_EQ(reinterpret_cast<std::uintptr_t>(grid.data()) % 256, 0U);
      EXPECT_GT(grid.report().seconds, 0);
      const std::vector<std::byte> found = bytes_of(grid);
      EXPECT_TRUE(test::expanded_file(made.file, found, type) == test::expand(made, type).file) << grid_type_name(type);
      buffer = std::move(grid).take_buffer();
    }
  }
}

TEST_F(ExpandedGridTest, AGridThatIsNotPackedIsCopiedAsItIs) {
  const test::TestGrid made({{0, 0, 0}, {20, 20, 20}}, [](const Index3& i) { return static_cast<float>(i.x); });
  const NvdbFile stock = file(made.file());
  const DeviceGrid grid = load_grid_as(stock, GridType::float32, {});
  const std::span<const std::byte> data = stock.grid().data();
  EXPECT_TRUE(bytes_of(grid) == std::vector<std::byte>(data.begin(), data.end()));
  EXPECT_EQ(message_of_error(ErrorKind::input, [&] { load_grid_as(stock, GridType::fp16, {}); }),
            path_ + ": is a grid of float32, not fp16; load it as it is: packed grids alone are expanded");
  EXPECT_EQ(message_of_error(ErrorKind::usage, [&] { load_grid_as(stock, GridType::fpn, {}); }),
            "a grid is expanded to float32 or fp16, not to fpn");
}

TEST_F(ExpandedGridTest, ADamagedBlockIsReported) {
  test::PackedFile made = test::PackedSample::build();
  const NvdbGrid whole = NvdbGrid::open(made.file, "a.nvdb");
  const GridBlock block = whole.block_at({200, 20, 30});
  ASSERT_TRUE(block.coded());
  made.file[static_cast<std::size_t>(block.stream.data - made.file.data())] |= std::byte{0x80};
  const NvdbFile packed = file(made.file);
  EXPECT_EQ(message_of_error(ErrorKind::input, [&] { load_grid_as(packed, GridType::float32, {}); }),
            path_ + ": 1 packed blocks are damaged; see weir verify");
}

}  // namespace
}  // namespace weir::expanded_grid_test
