// Tests the page of weir view in a real browser; the steps are in page_test.py. WEIR_PAGE_SCREENSHOTS=DIRECTORY keeps
// screenshots.
#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/support/python.h"
#include "tests/support/run_command.h"
#include "tests/support/temporary_directory.h"
#include "tools/view/jpeg_picture.h"

namespace weir::view_page_test {
namespace {

bool is_installed(const std::string& command) {
  return std::system(("command -v " + command + " >/dev/null").c_str()) == 0;
}

class ViewPageTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!is_installed("chromium") || !is_installed("chromedriver")) {
      GTEST_SKIP() << "chromium or chromedriver is not installed; see tools/setup.sh";
    }
  }

  /// Makes a cloud of 64^3 voxels as DIRECTORY/NAME.
  std::string cloud(const std::string& name, const std::string& rate = "8", const std::string& seed = "1") {
    const std::string raw = directory_ / ("c" + seed + "_64x64x64_float32.raw");
    if (!std::filesystem::exists(raw)) {
      EXPECT_EQ(run_weir({"sample", "cloud", "--dims", "64,64,64", "--seed", seed, "-o", raw}).exit_code, 0);
    }
    const std::string volume = directory_ / name;
    const auto made = run_weir({"convert", raw, "-o", volume, "--encoding", "packed", "--rate", rate});
    EXPECT_EQ(made.exit_code, 0) << made.err;
    return volume;
  }

  void run(const std::string& name, const std::vector<std::string>& arguments) {
    std::vector<std::string> command = {
        kPython,     "-B", WEIR_SOURCE_DIR "/tests/tools/view/page_test.py", name, directory_.path().string(),
        WEIR_COMMAND};
    command.insert(command.end(), arguments.begin(), arguments.end());
    CommandOptions options;
    options.timeout = std::chrono::minutes(5);  // a browser on a busy machine
    options.environment = {has_jpeg() ? "WEIR_MOVING_FORMAT=jpeg" : "WEIR_MOVING_FORMAT=png"};
    const CommandResult result = run_command(command, options);
    EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
  }

  TemporaryDirectory directory_;
};

TEST_F(ViewPageTest, TurnsAndRefines) { run("turns_and_refines", {cloud("a.nvdb")}); }

TEST_F(ViewPageTest, WorksWithKeys) { run("works_with_keys", {cloud("a.nvdb")}); }

TEST_F(ViewPageTest, WorksByTouch) { run("works_by_touch", {cloud("a.nvdb")}); }

TEST_F(ViewPageTest, EditsTheTransferFunction) { run("edits_the_transfer_function", {cloud("a.nvdb")}); }

TEST_F(ViewPageTest, ShowsTheOpacityOfTheRange) { run("shows_the_opacity_of_the_range", {cloud("a.nvdb")}); }

TEST_F(ViewPageTest, TakesExtremeValues) { run("takes_extreme_values", {cloud("a.nvdb")}); }

TEST_F(ViewPageTest, TellsValues) { run("tells_values", {cloud("a.nvdb")}); }

TEST_F(ViewPageTest, ScrubsASeries) {
  for (const char* step : {"1", "2", "3"}) cloud(std::string("s_") + step + ".nvdb", "8", step);
  run("scrubs_a_series", {directory_ / "s_*.nvdb"});
}

TEST_F(ViewPageTest, TellsStepsOfOneBaseNameApart) {
  for (const char* letter : {"A", "B", "C"}) {
    const std::string folder = std::string("run") + letter;
    std::filesystem::create_directory(directory_ / folder);
    cloud(folder + "/out.nvdb");
  }
  run("tells_steps_of_one_base_name_apart", {directory_ / "run*/out.nvdb"});
}

TEST_F(ViewPageTest, ShowsStepsThatCome) {
  for (const char* step : {"0", "2", "3", "4"}) cloud(std::string("later_s_") + step + ".nvdb", "8", step);
  run("shows_steps_that_come", {cloud("s_1.nvdb"), "--series"});
}

TEST_F(ViewPageTest, ComparesTwoFiles) {
  const std::string good = cloud("a.nvdb", "4");
  run("compares_two_files", {good, "--against", cloud("b.nvdb", "60")});
}

TEST_F(ViewPageTest, ShowsTheConversion) { run("converts", {cloud("a.nvdb")}); }

TEST_F(ViewPageTest, AsksForTheConversionAgain) { run("asks_again", {cloud("a.nvdb"), "--allow-convert"}); }

TEST_F(ViewPageTest, ShowsAFileWithValuesThatAreNotFinite) {
  const std::string raw = directory_ / "n_16x16x16_float32.raw";
  std::string bytes(std::size_t{16} * 16 * 16 * 4, '\0');
  bytes.replace(bytes.size() - 4, 4, std::string("\0\0\x80\x7f", 4));  // infinity
  write_file(raw, bytes);
  const auto made = run_weir(
      {"convert", raw, "-o", directory_ / "n.nvdb", "--encoding", "float", "--lossless", "--nonfinite", "keep"});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  run("shows_values_that_are_not_finite", {directory_ / "n.nvdb"});
}

TEST_F(ViewPageTest, SavedSceneGivesTheSamePicture) { run("saved_scene_gives_the_same_picture", {cloud("a.nvdb")}); }

TEST_F(ViewPageTest, FitsWindows) { run("fits_windows", {cloud("a.nvdb")}); }

TEST_F(ViewPageTest, StaysWhileOthersBreak) { run("stays_while_others_break", {cloud("a.nvdb")}); }

TEST_F(ViewPageTest, AsksForTheToken) {
  write_file(directory_ / "token", "secret\n");
  std::filesystem::permissions(directory_ / "token", std::filesystem::perms(0600));
  run("asks_for_the_token", {cloud("a.nvdb"), "--token-file", directory_ / "token"});
}

TEST_F(ViewPageTest, SaysWhenTheServerIsGone) { run("says_when_the_server_is_gone", {cloud("a.nvdb")}); }

}  // namespace
}  // namespace weir::view_page_test
