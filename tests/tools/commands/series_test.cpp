// Tests the conversion of a series on the command line: each step becomes a file, and all files have the same size.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "format/base/text.h"
#include "tests/support/run_command.h"

namespace weir::series_test {
namespace {

class SeriesCommand : public testing::Test {
 protected:
  void write_steps(int count) const {
    for (int i = 0; i < count; ++i) {
      std::string bytes(64 * 48 * 40, '\0');
      for (std::size_t b = 0; b < bytes.size(); ++b)
        bytes[b] = static_cast<char>((b * static_cast<std::size_t>(i + 3)) % 251);
      write_file(directory_.path() / ("t_" + std::to_string(i) + "_64x48x40_uint8.raw"), bytes);
    }
  }

  TemporaryDirectory directory_;
  std::string pattern_ = directory_ / "t_%d_64x48x40_uint8.raw";
};

TEST_F(SeriesCommand, EveryStepHasTheSameSizeAndItsOwnValues) {
  write_steps(3);
  std::filesystem::create_directory(directory_.path() / "out");
  const auto made =
      run_weir({"convert", pattern_, "-o", directory_ / "out/{stem}-{step}.nvdb", "--size", "400000", "--json"});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const auto steps = nlohmann::json::parse(made.out)["steps"];
  ASSERT_EQ(steps.size(), 3U);
  for (int i = 0; i < 3; ++i) {
    const std::string stem = "t_" + std::to_string(i) + "_64x48x40_uint8";
    const std::string volume = directory_ / ("out/" + stem + "-" + std::to_string(i) + ".nvdb");
    EXPECT_EQ(std::filesystem::file_size(volume), 400000U);
    EXPECT_EQ(steps[static_cast<std::size_t>(i)]["source"]["path"], directory_ / (stem + ".raw"));
    const auto compared = run_weir({"compare", directory_ / (stem + ".raw"), volume, "--json"});
    const double certified = steps[static_cast<std::size_t>(i)]["error"]["mse"];
    EXPECT_NEAR(nlohmann::json::parse(compared.out)["mse"], certified, 1e-12 * certified);
  }
  EXPECT_EQ(list_directory(directory_.path() / "out").size(), 6U);
}

// If a step were left out, as by a pattern of the shell, two of three steps would pass for the whole series.
TEST_F(SeriesCommand, StepThatCannotBeRead_IsNotLeftOut) {
  write_steps(3);
  const std::string step = directory_ / "t_1_64x48x40_uint8.raw";
  const auto refused = [&](const std::string& what) {
    const auto made = run_weir({"convert", pattern_, "--lossless", "-o", directory_ / "out/", "--overwrite"});
    EXPECT_EQ(made.exit_code, 3);
    EXPECT_NE(made.err.find(cat("weir: ", step, ": ", what, "\n")), std::string::npos) << made.err;
    EXPECT_NE(made.err.find("1 of 3 volumes"), std::string::npos) << made.err;
  };
  std::filesystem::remove(step);
  std::filesystem::create_symlink(directory_ / "none", step);
  refused("cannot open for reading: No such file or directory");
  std::filesystem::remove(step);
  std::filesystem::create_directory(step);
  refused("is a directory; name a file in it");
}

TEST_F(SeriesCommand, RefusesOneOutputNameForAllSteps) {
  write_steps(2);
  const auto made = run_weir({"convert", pattern_, "-o", directory_ / "one.nvdb"});
  EXPECT_EQ(made.exit_code, 2);
  EXPECT_NE(made.err.find("2 volumes, and two of them"), std::string::npos) << made.err;
  EXPECT_FALSE(std::filesystem::exists(directory_.path() / "one.nvdb"));
}

TEST_F(SeriesCommand, RefusesWhatExistsBeforeTheFirstStep) {
  write_steps(2);
  write_file(directory_.path() / "t_1_64x48x40_uint8.nvdb", "precious");
  const auto made = run_weir({"convert", pattern_});
  EXPECT_EQ(made.exit_code, 2);
  EXPECT_EQ(made.err, "weir: " + directory_ / "t_1_64x48x40_uint8.nvdb" +
                          ": exists; choose another output or pass --overwrite\n");
  EXPECT_FALSE(std::filesystem::exists(directory_.path() / "t_0_64x48x40_uint8.nvdb"));
}

TEST_F(SeriesCommand, StepsOfTwoExtentsNeedASize) {
  write_steps(1);
  const std::string other = directory_ / "u_9x8x7_uint8.raw";
  write_file(other, std::string(9 * 8 * 7, '\5'));
  const std::string first = directory_ / "t_0_64x48x40_uint8.raw";
  const auto by_rate = run_weir({"convert", first, other, "--rate", "1"});
  EXPECT_EQ(by_rate.exit_code, 3);
  EXPECT_FALSE(std::filesystem::exists(directory_.path() / "t_0_64x48x40_uint8.nvdb")) << "the first is converted";
  EXPECT_NE(by_rate.err.find(other + ": extent 9x8x7 differs from 64x48x40 of " + first +
                             ", so that a rate gives files of two sizes; give --size"),
            std::string::npos)
      << by_rate.err;
  const auto by_default = run_weir({"convert", first, other});
  EXPECT_EQ(by_default.exit_code, 0) << by_default.err;
  EXPECT_NE(by_default.err.find("; give --size for files of one size\n"), std::string::npos) << by_default.err;
  EXPECT_NE(by_default.err.find(directory_ / "u_9x8x7_uint8.nvdb" + ": "), std::string::npos) << by_default.err;
  EXPECT_NE(by_default.err.find(" bytes, and " + directory_ / "t_0_64x48x40_uint8.nvdb" + " has "), std::string::npos)
      << by_default.err;
  const auto by_size = run_weir({"convert", first, other, "--size", "1MB", "--overwrite"});
  EXPECT_EQ(by_size.exit_code, 0) << by_size.err;
  EXPECT_EQ(std::filesystem::file_size(directory_.path() / "u_9x8x7_uint8.nvdb"), 1000000U);
}

TEST_F(SeriesCommand, ShellPatternInQuotes_IsASeries) {
  write_steps(3);
  CommandOptions here;
  here.directory = directory_.path();
  const auto made = run_weir({"convert", "t_*.raw", "-o", "out/", "--size", "400000"}, here);
  ASSERT_EQ(made.exit_code, 0) << made.err;
  EXPECT_EQ(list_directory(directory_.path() / "out"),
            (std::vector<std::string>{"t_0_64x48x40_uint8.nvdb", "t_0_64x48x40_uint8.nvdb.json",
                                      "t_1_64x48x40_uint8.nvdb", "t_1_64x48x40_uint8.nvdb.json",
                                      "t_2_64x48x40_uint8.nvdb", "t_2_64x48x40_uint8.nvdb.json"}));
}

TEST_F(SeriesCommand, SeveralPositionsOfAnArray_HaveANameEach) {
  const std::string nrrd = directory_ / "a.nrrd";
  write_file(nrrd, "NRRD0004\ntype: uchar\ndimension: 4\nsizes: 5 4 3 12\nencoding: raw\n\n" + std::string(720, '\7'));
  const auto made = run_weir({"convert", nrrd, "--index", "-3:", "-o", directory_ / "out/", "--size", "400000"});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  EXPECT_EQ(list_directory(directory_.path() / "out"),
            (std::vector<std::string>{"a_09.nvdb", "a_09.nvdb.json", "a_10.nvdb", "a_10.nvdb.json", "a_11.nvdb",
                                      "a_11.nvdb.json"}));
}

TEST_F(SeriesCommand, AStepThatFails_IsSaidWithWhatWasDone) {
  for (int i = 0; i < 3; ++i) {
    std::string bytes(16 * 16 * 16 * sizeof(float), '\0');
    if (i == 1) bytes.replace(0, 4, "\xFF\xFF\xFF\xFF");  // NaN
    write_file(directory_ / cat("n_", i, "_16x16x16_float32.raw"), bytes);
  }
  const auto made =
      run_weir({"convert", directory_ / "n_%d_16x16x16_float32.raw", "-o", directory_ / "out/", "--size", "400000"});
  EXPECT_EQ(made.exit_code, 3);
  EXPECT_NE(made.err.find("1 of 3 volumes were converted, and none from " +
                          (directory_ / "out/n_1_16x16x16_float32.nvdb") + " on; --skip-done leaves out what is done"),
            std::string::npos)
      << made.err;
}

TEST_F(SeriesCommand, AVolumeOfAFileThatFails_IsSaidByItsOutput) {
  std::string bytes(3 * 16 * 16 * 16 * sizeof(float), '\0');
  bytes.replace(16 * 16 * 16 * sizeof(float), 4, "\xFF\xFF\xFF\xFF");  // NaN, in the second volume
  const std::string nrrd = directory_ / "a.nrrd";
  write_file(nrrd, "NRRD0004\ntype: float\ndimension: 4\nsizes: 16 16 16 3\nencoding: raw\nendian: little\n\n" + bytes);
  const auto made = run_weir({"convert", nrrd, "--index", "*", "-o", directory_ / "out/", "--size", "400000"});
  EXPECT_EQ(made.exit_code, 3);
  EXPECT_NE(made.err.find("1 of 3 volumes were converted, and none from " + (directory_ / "out/a_1.nvdb") + " on; "),
            std::string::npos)
      << made.err;
}

TEST_F(SeriesCommand, AStackIsOneVolume) {
  const std::string whole = directory_ / "w_64x48x40_uint8.raw";
  std::string bytes(64 * 48 * 40, '\0');
  for (std::size_t b = 0; b < bytes.size(); ++b) bytes[b] = static_cast<char>(b % 251);
  write_file(whole, bytes);
  for (std::size_t z = 0; z < 40; ++z) {
    write_file(directory_.path() / ("p_" + std::to_string(1000 + z) + ".raw"), bytes.substr(z * 64 * 48, 64 * 48));
  }
  const std::string stacked = directory_ / "stacked.nvdb";
  const std::vector<std::string> stack{directory_ / "p_%04d.raw", "--stack", "--dims", "64,48,1", "--type", "uint8"};
  std::vector<std::string> convert{"convert", "-o", stacked, "--lossless"};
  convert.insert(convert.end(), stack.begin(), stack.end());
  const auto made = run_weir(convert);
  ASSERT_EQ(made.exit_code, 0) << made.err;
  EXPECT_EQ(run_weir({"convert", whole, "-o", directory_ / "w.nvdb", "--lossless"}).exit_code, 0);
  EXPECT_EQ(read_file(stacked), read_file(directory_ / "w.nvdb"));
  std::vector<std::string> compare{"compare", stacked};
  compare.insert(compare.begin() + 1, stack.begin(), stack.end());
  EXPECT_EQ(run_weir(compare).out, "lossless: all 122880 finite voxels read bit for bit\n");
}

}  // namespace
}  // namespace weir::series_test
