// Tests that a conversion reports and records axes that differ from those of the file's world.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "format/base/text.h"
#include "tests/support/run_command.h"

namespace weir::orientation_test {
namespace {

TEST(Orientation, OfFlippedAxes_IsSaidAndRecorded) {
  const TemporaryDirectory directory;
  write_file(directory / "a.raw", std::string(8 * 8 * 8, '\1') + std::string(8 * 8 * 8, '\2'));
  const std::string head = directory / "a.mhd";
  const auto write_head = [&](const std::string& matrix) {
    write_file(head, "ObjectType = Image\nNDims = 3\nTransformMatrix = " + matrix +
                         "\nOffset = 10 20 30\nElementSpacing = 2 2 2\nDimSize = 8 8 16\nElementType = MET_UCHAR\n"
                         "ElementDataFile = a.raw\n");
  };
  const auto convert = [&] {
    return run_weir({"convert", head, "-o", directory / "a.nvdb", "--lossless", "--overwrite", "--json"});
  };
  write_head("-1 0 0 0 1 0 0 0 1");
  const CommandResult flipped = convert();
  ASSERT_EQ(flipped.exit_code, 0) << flipped.err;
  const std::string orientation = "axes along -x, +y, +z of the file's world; voxels keep the file's order";
  EXPECT_NE(flipped.err.find(cat(head, ": ", orientation, '\n')), std::string::npos) << flipped.err;
  EXPECT_EQ(nlohmann::json::parse(flipped.out)["source"]["orientation"], orientation);
  write_head("1 0 0 0 1 0 0 0 1");
  const CommandResult plain = convert();
  ASSERT_EQ(plain.exit_code, 0) << plain.err;
  EXPECT_EQ(plain.err.find("axes along"), std::string::npos) << plain.err;
  EXPECT_FALSE(nlohmann::json::parse(plain.out)["source"].contains("orientation"));
}

}  // namespace
}  // namespace weir::orientation_test
