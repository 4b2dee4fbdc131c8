#include "tools/report/map_warning.h"

#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <string>

#include "format/layout/nanovdb_layout.h"
#include "format/nanovdb/nvdb_file.h"
#include "tests/support/run_command.h"

namespace weir::map_warning_test {
namespace {

// Returns the file's bytes with another matrix of doubles, row-major.
std::string with_matrix(std::string bytes, std::uint64_t grid, const std::array<double, 9>& matrix) {
  std::memcpy(bytes.data() + grid + nvdb::grid::kMap + 88, matrix.data(), sizeof(matrix));
  return bytes;
}

class MapWarning : public testing::Test {
 protected:
  void SetUp() override {
    const std::string raw = directory_ / "v_9x8x7_float32.raw";
    ASSERT_EQ(run_weir({"sample", "gradient", "-o", raw}).exit_code, 0);
    ASSERT_EQ(run_weir({"convert", raw, "--lossless", "--spacing", "1,2,3.5", "-o", path_}).exit_code, 0);
  }
  std::string warning_with(const std::array<double, 9>& matrix) const {
    write_file(changed_, with_matrix(read_file(path_), NvdbFile(path_).grid().grid_offset(), matrix));
    return map_warning(NvdbFile(changed_).grid());
  }

  TemporaryDirectory directory_;
  std::string path_ = directory_ / "v.nvdb";
  std::string changed_ = directory_ / "w.nvdb";
};

TEST_F(MapWarning, ScaledAndMoved_IsNone) {
  EXPECT_EQ(map_warning(NvdbFile(path_).grid()), "");
  EXPECT_EQ(warning_with({1, 1e-9, 0, 0, 2, 0, 0, 0, 3.5}), "") << "rounding";
}

TEST_F(MapWarning, RotatedShearedOrMirrored) {
  const std::string expected =
      "its map rotates, shears or mirrors the grid; pictures and positions follow the grid's own axes, with its voxel "
      "size alone";
  EXPECT_EQ(warning_with({0, -2, 0, 1, 0, 0, 0, 0, 3.5}), expected);
  EXPECT_EQ(warning_with({1, 0, 0.5, 0, 2, 0, 0, 0, 3.5}), expected);
  EXPECT_EQ(warning_with({1, 0, 0, 0, -2, 0, 0, 0, 3.5}), expected);
}

TEST_F(MapWarning, PicturesSayIt) {
  warning_with({0, -2, 0, 1, 0, 0, 0, 0, 3.5});
  const CommandResult rendered =
      run_weir({"render", changed_, "-o", directory_ / "p.png", "--size", "16x12", "--spp", "1", "--backend", "cpu"});
  EXPECT_EQ(rendered.exit_code, 0);
  EXPECT_NE(rendered.err.find(changed_ + ": its map rotates"), std::string::npos) << rendered.err;
  const CommandResult played =
      run_weir({"play", changed_, "-o", directory_ / "frames", "--size", "16x12", "--spp", "1", "--backend", "cpu"});
  EXPECT_EQ(played.exit_code, 0);
  EXPECT_NE(played.err.find(changed_ + ": its map rotates"), std::string::npos) << played.err;
  const CommandResult inspected = run_weir({"inspect", changed_});
  EXPECT_EQ(inspected.exit_code, 0);
  EXPECT_NE(inspected.out.find("origin 0, 0, 0\n            its map rotates"), std::string::npos) << inspected.out;
}

}  // namespace
}  // namespace weir::map_warning_test
