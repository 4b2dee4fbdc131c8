#include "tools/report/input_listing.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "format/base/text.h"
#include "tests/support/plotfile_writer.h"
#include "tests/support/run_command.h"

namespace weir::input_listing_test {
namespace {

/// Runs the only command that inspect prints for `words`, and returns the sidecar of its output.
nlohmann::json converted_as_printed(const std::vector<std::string>& words) {
  const CommandResult shown = run_weir(words);
  EXPECT_EQ(shown.exit_code, 0) << shown.err;
  const std::size_t at = shown.out.find("  weir convert ");
  if (at == std::string::npos || shown.out.find("weir convert ", at + 3) != std::string::npos) {
    ADD_FAILURE() << shown.out;
    return {};
  }
  const TemporaryDirectory results;
  const std::string command = shown.out.substr(at + 2, shown.out.find('\n', at) - at - 2);
  const CommandResult made = run_command(
      {"bash", "-c", cat("weir() { " WEIR_COMMAND " \"$@\"; }\n", command, " --json -o ", results / "made.nvdb")});
  EXPECT_EQ(made.exit_code, 0) << command << ": " << made.err;
  return made.exit_code == 0 ? nlohmann::json::parse(made.out) : nlohmann::json();
}

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

TEST(InputListing, CommandHasTheLayoutThatWasGiven) {
  const TemporaryDirectory directory;
  const std::string path = directory / "a dump.bin";
  write_file(path, std::string(100, 'x') + std::string(24, '\2'));
  const std::vector<std::string> words{"inspect",  path,  "--dims",    "4,3,2",  "--type",    "uint8",
                                       "--offset", "100", "--spacing", "2,2,.5", "--missing", "7"};
  const nlohmann::json made = converted_as_printed(words);
  EXPECT_EQ(made["source"]["extent"], (std::vector<int>{4, 3, 2}));
  EXPECT_EQ(made["value_range"], (std::vector<int>{2, 2}));
  EXPECT_EQ(made["grid"]["voxel_size"], (std::vector<double>{2, 2, .5}));
  EXPECT_EQ(made["weir"]["options"]["missing"], "7");
  std::vector<std::string> as_json = words;
  as_json.push_back("--json");
  EXPECT_EQ(nlohmann::json::parse(run_weir(as_json).out)["datasets"][0]["command"],
            "weir convert '" + path + "' --dims=4,3,2 --type=uint8 --offset=100 --spacing=2,2,.5 --missing=7");
}

TEST(InputListing, CommandReadsTheLevelThatIsListed) {
  const TemporaryDirectory directory;
  const std::string path = directory / "plt00042";
  test::PlotfilePlan plan;
  plan.ratios = {{2, 2, 2}};
  plan.boxes = {{{{0, 0, 0}, {16, 16, 16}}}, {{{0, 0, 0}, {8, 8, 8}}}};
  test::write_plotfile(path, plan);
  EXPECT_EQ(converted_as_printed({"inspect", path})["source"]["extent"], (std::vector<int>{32, 32, 32}));
  EXPECT_EQ(converted_as_printed({"inspect", path, "--level", "0"})["source"]["extent"],
            (std::vector<int>{16, 16, 16}));
  EXPECT_EQ(converted_as_printed({"inspect", path, "--dataset", "density", "--level", "0"})["source"]["extent"],
            (std::vector<int>{16, 16, 16}));
}

TEST(InputListing, AStackIsOneVolume) {
  const TemporaryDirectory directory;
  for (int i = 0; i < 3; ++i) write_file(directory / cat("s_", i, ".raw"), std::string(24, '\1'));
  const std::string pattern = directory / "s_%d.raw";
  const std::vector<std::string> words{"inspect", "--stack", pattern, "--dims", "4,3,2", "--type", "uint8"};
  EXPECT_EQ(run_weir(words).out, pattern + ": stack, 1 volume\n\n4 x 3 x 6 uint8\n  weir convert " + pattern +
                                     " --dims=4,3,2 --type=uint8 --stack\n");
  EXPECT_EQ(converted_as_printed(words)["source"]["extent"], (std::vector<int>{4, 3, 6}));
}

}  // namespace
}  // namespace weir::input_listing_test
