#include "tools/report/input_listing.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/support/run_command.h"

namespace weir::input_listing_test {
namespace {

TEST(InputListing, ARawFileIsOneVolume) {
  const TemporaryDirectory directory;
  const std::string path = directory / "a_4x3x2_uint8.raw";
  write_file(path, std::string(24, '\1'));
  const auto text = run_weir({"inspect", path});
  EXPECT_EQ(text.exit_code, 0) << text.err;
  EXPECT_EQ(text.out, path + ": raw, 1 volume\n\n4 x 3 x 2 uint8, contiguous\n  weir convert " + path + '\n');

  const auto json = nlohmann::json::parse(run_weir({"inspect", path, "--json"}).out);
  EXPECT_EQ(json["format"], "raw");
  ASSERT_EQ(json["datasets"].size(), 1U);
  EXPECT_EQ(json["datasets"][0]["extents"], (std::vector<int>{4, 3, 2}));
  EXPECT_EQ(json["datasets"][0]["command"], "weir convert " + path);
  EXPECT_TRUE(json["datasets"][0]["obstacle"].is_null());
}

TEST(InputListing, AnInputHasNoHistogramToPlot) {
  const TemporaryDirectory directory;
  const std::string path = directory / "a_4x3x2_uint8.raw";
  write_file(path, std::string(24, '\1'));
  const auto result = run_weir({"inspect", path, "--plot", directory / "a.png"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(result.err, "weir: --plot is for .nvdb files, and " + path + " is none; convert it first\n");
}

}  // namespace
}  // namespace weir::input_listing_test
