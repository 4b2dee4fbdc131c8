// Tests that a picture cannot replace one of its own inputs.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "tests/support/run_command.h"
#include "tests/support/temporary_directory.h"

namespace weir::picture_inputs_test {
namespace {

TEST(PictureInputs, NothingThatAPictureIsMadeFrom_IsReplacedByIt) {
  const TemporaryDirectory directory;
  const std::string volume = directory / "c.nvdb";
  const std::string raw = directory / "c_70x60x50_float32.raw";
  ASSERT_EQ(run_weir({"sample", "cloud", "-o", raw}).exit_code, 0);
  ASSERT_EQ(run_weir({"convert", raw, "--lossless", "-o", volume}).exit_code, 0);
  const auto sky = directory / "sky.exr";
  EXPECT_EQ(run_weir({"render", volume, "-o", sky, "--size", "8x4", "--spp", "1", "-q"}).exit_code, 0);
  const auto scene = directory / "scene.png";
  write_file(scene, "mode = \"mip\"\n[lighting]\nenvironment = \"sky.exr\"\n");
  const auto named_volume = directory / "volume.png";
  std::filesystem::copy_file(volume, named_volume);
  const auto named_raw = directory / "raw.png";
  std::filesystem::rename(raw, named_raw);
  const std::vector<std::vector<std::string>> calls{
      {"render", volume, "--scene", scene, "-o", sky},
      {"render", volume, "--scene", scene, "-o", scene},
      {"render", named_volume, "-o", named_volume},
      {"render", named_raw, "--volume", "dense", "--dims", "70,60,50", "--type", "float32", "-o", named_raw}};
  for (std::vector<std::string> call : calls) {
    const std::string target = call.back();
    const std::string before = read_file(target);
    call.insert(call.end(), {"--overwrite", "--size", "8x4", "--spp", "1", "-q"});
    const CommandResult result = run_weir(call);
    EXPECT_EQ(result.exit_code, 2) << target;
    EXPECT_EQ(result.err, "weir: " + target + ": belongs to the input, and writing " + target +
                              " would replace or remove it; choose another output\n");
    EXPECT_EQ(read_file(target), before);
  }
  const auto frames = directory / "frames";
  std::filesystem::create_directory(frames);
  const std::string frame = frames + "/frame_00000.png";
  std::filesystem::copy_file(volume, frame);
  const CommandResult played = run_weir({"play", frame, "-o", frames, "--mode", "mip", "--size", "8x4", "-q"});
  EXPECT_EQ(played.exit_code, 2);
  EXPECT_NE(played.err.find(": belongs to the input, and writing "), std::string::npos) << played.err;
}

}  // namespace
}  // namespace weir::picture_inputs_test
