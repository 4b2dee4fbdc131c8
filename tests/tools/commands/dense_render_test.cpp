// Tests weir render --volume dense from outside: a source and its lossless file give the same picture.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/support/run_command.h"

namespace weir::dense_render_test {
namespace {

class DenseRender : public ::testing::Test {
 protected:
  /// Returns the bytes of a linear picture, or the error message.
  std::string picture(const std::vector<std::string>& input, const std::vector<std::string>& look) const {
    const std::string image = directory_ / "a.exr";
    std::filesystem::remove(image);
    std::vector<std::string> all{"render", "-o", image, "--size", "32x24", "--spp", "2"};
    all.insert(all.end(), input.begin(), input.end());
    all.insert(all.end(), look.begin(), look.end());
    const CommandResult result = run_weir(all);
    return result.exit_code == 0 ? read_file(image) : result.err;
  }
  void expect_same_pictures(const std::string& raw, const std::vector<std::string>& convert,
                            const std::vector<std::vector<std::string>>& looks) const {
    const std::string volume = directory_ / "v.nvdb";
    std::vector<std::string> all{"convert", raw, "-o", volume, "--lossless", "--overwrite"};
    all.insert(all.end(), convert.begin(), convert.end());
    const CommandResult converted = run_weir(all);
    ASSERT_EQ(converted.exit_code, 0) << converted.err;
    for (const auto& look : looks) {
      const std::string of_file = picture({volume}, look);
      EXPECT_GT(of_file.size(), 300U) << of_file;
      EXPECT_TRUE(picture({raw, "--volume", "dense"}, look) == of_file) << raw << ' ' << ::testing::PrintToString(look);
    }
  }
  std::string sample(const std::string& kind, const std::string& shape) const {
    std::string raw = directory_ / (kind + "_" + shape + ".raw");
    EXPECT_EQ(run_weir({"sample", kind, "-o", raw}).exit_code, 0);
    return raw;
  }
  void expect_refused(const std::vector<std::string>& arguments, int exit_code, const std::string& line) const {
    const CommandResult result = run_weir(arguments);
    EXPECT_EQ(result.exit_code, exit_code);
    EXPECT_EQ(result.err, "weir: " + line + "\n");
  }

  TemporaryDirectory directory_;
};

TEST_F(DenseRender, EveryModeAndFilterOfALosslessFile) {
  std::vector<std::vector<std::string>> looks;
  for (const std::string mode : {"path", "dvr", "iso", "mip"}) {
    for (const std::string filter : {"nearest", "trilinear", "stochastic"}) {
      looks.push_back({"--mode", mode, "--filter", filter, "--seed", "7"});
    }
  }
  expect_same_pictures(sample("cloud", "70x60x50_float32"), {"--encoding", "float"}, looks);
  expect_same_pictures(sample("cloud", "70x60x50_uint8"), {}, looks);
}

TEST_F(DenseRender, HardVolumes) {
  const std::vector<std::vector<std::string>> looks{{"--mode", "path"}, {"--mode", "iso"}};
  for (const std::string kind :
       {"zero", "constant", "nan", "denormal", "negative-zero", "huge", "tiny", "offset", "big-integer", "ties",
        "background", "signed", "hot-voxel", "plateau", "checkerboard", "nearly-constant", "noise"}) {
    expect_same_pictures(sample(kind, "21x37x18_float32"), {"--nonfinite", "keep"}, looks);
  }
  // The root of a file with infinities names no finite range, so the scene names one.
  const std::string scene = directory_ / "s.toml";
  write_file(scene, "[volume]\nrange = [0, 1]\n");
  expect_same_pictures(sample("some-nan", "21x37x18_float32"), {"--nonfinite", "keep"},
                       {{"--mode", "path", "--scene", scene}, {"--mode", "iso", "--scene", scene}});
}

TEST_F(DenseRender, HardShapes) {
  for (const std::string shape : {"1x1x1", "1x1x200", "200x1x1", "8x8x8", "129x3x2", "1x130x17"}) {
    expect_same_pictures(sample("noise", shape + "_float32"), {}, {{"--mode", "path"}, {"--mode", "dvr"}});
  }
}

TEST_F(DenseRender, PlacedAndCutByTheInputOptions) {
  const std::string raw = sample("signed", "40x30x20_int16");
  const std::vector<std::string> cut{"--roi", "3:33,5:30,1:18", "--spacing", "1,2,0.5", "--origin", "-4,7,1e3"};
  std::vector<std::string> convert{"convert", raw, "-o", directory_ / "v.nvdb", "--lossless"};
  convert.insert(convert.end(), cut.begin(), cut.end());
  ASSERT_EQ(run_weir(convert).exit_code, 0);
  std::vector<std::string> dense{raw, "--volume", "dense"};
  dense.insert(dense.end(), cut.begin(), cut.end());
  EXPECT_TRUE(picture({directory_ / "v.nvdb"}, {}) == picture(dense, {}));
  // Raw bytes whose name does not describe them; voxels without data become the background.
  std::filesystem::rename(raw, directory_ / "plain");
  const std::vector<std::string> shape{"--dims",    "40,30,20", "--type",           "int16",
                                       "--missing", "0",        "--missing-policy", "background"};
  dense = {directory_ / "plain", "--volume", "dense"};
  dense.insert(dense.end(), shape.begin(), shape.end());
  convert = {"convert", directory_ / "plain", "-o", directory_ / "v.nvdb", "--lossless", "--overwrite"};
  convert.insert(convert.end(), shape.begin(), shape.end());
  ASSERT_EQ(run_weir(convert).exit_code, 0);
  EXPECT_TRUE(picture({directory_ / "v.nvdb"}, {}) == picture(dense, {}));
}

TEST_F(DenseRender, NanoVdbFile_RendersAsADenseVolume) {
  const std::string raw = sample("cloud", "40x40x40_float32");
  ASSERT_EQ(run_weir({"convert", raw, "-o", directory_ / "v.nvdb", "--lossless"}).exit_code, 0);
  EXPECT_TRUE(picture({directory_ / "v.nvdb", "--volume", "dense"}, {}) == picture({directory_ / "v.nvdb"}, {}));
}

TEST_F(DenseRender, Json) {
  const std::string raw = sample("cloud", "40x30x20_uint8");
  const CommandResult result = run_weir(
      {"render", raw, "-o", directory_ / "a.png", "--size", "8x6", "--spp", "1", "--volume", "dense", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto report = nlohmann::json::parse(result.out);
  EXPECT_EQ(report["volume"], "dense");
  EXPECT_EQ(report["load"]["way"], "memory");
  EXPECT_EQ(report["load"]["bytes"], 40 * 30 * 20 * 4);
}

TEST_F(DenseRender, Refusals) {
  const std::string raw = sample("cloud", "40x30x20_uint8");
  const std::string image = directory_ / "a.png";
  expect_refused({"render", raw, "-o", image, "--dims", "40,30,20"}, 2,
                 "--dims says how to read a source; give --volume dense with it");
  expect_refused({"render", raw, "-o", image, "--stack"}, 2,
                 "--stack says how to read a source; give --volume dense with it");
  expect_refused({"render", raw, "-o", image, "--volume", "dense", "--spacing", "1,2"}, 2,
                 "--spacing is \"1,2\", it must be x,y,z, three numbers in world units");
  expect_refused({"render", raw, "-o", image, "--volume", "dense", "--memory", "1MiB"}, 2,
                 raw +
                     ": --volume dense holds all 40 x 30 x 20 voxels and needs 132.1 MiB of memory, --memory allows "
                     "1.0 MiB; show a part with --roi, or convert it and render the file");
  const std::string first = (std::filesystem::path(raw).parent_path() / "m_2x2x1_uint8.raw").string();
  write_file(first, std::string("\x05\x07\x05\x05", 4));
  expect_refused({"render", first, "-o", image, "--volume", "dense", "--missing", "7", "--missing-policy", "error"}, 3,
                 first +
                     ": 1 of 4 voxels (25 %) holds no data (stored as 7), the first at 1,0,0; choose --missing-policy "
                     "background or, to take 7 for data, --missing-policy keep");
  EXPECT_FALSE(std::filesystem::exists(image));
}

// A sparse file: the memory is checked before anything of it is read.
TEST_F(DenseRender, VolumeLargerThanMemory_IsRefused) {
  const std::string raw = directory_ / "a_65536x65536x256_uint8.raw";
  { std::ofstream{raw}; }
  std::error_code too_large;
  std::filesystem::resize_file(raw, std::uint64_t{1} << 40U, too_large);
  if (too_large) GTEST_SKIP() << "this file system holds no sparse file of 1 TiB";
  const CommandResult result = run_weir({"render", raw, "-o", directory_ / "a.png", "--volume", "dense"});
  EXPECT_EQ(result.exit_code, 2);
  const std::string start =
      "weir: " + raw + ": --volume dense holds all 65536 x 65536 x 256 voxels and needs 4.0 TiB of memory, ";
  EXPECT_EQ(result.err.substr(0, start.size()), start);
  const std::string end = " are available; show a part with --roi, or convert it and render the file\n";
  ASSERT_GT(result.err.size(), end.size());
  EXPECT_EQ(result.err.substr(result.err.size() - end.size()), end);
}

}  // namespace
}  // namespace weir::dense_render_test
