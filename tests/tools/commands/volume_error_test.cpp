// Tests which file weir render and weir play name if they cannot draw a volume.
#include <gtest/gtest.h>

#include <filesystem>

#include "format/base/text.h"
#include "tests/tools/support/converted_volume.h"

namespace weir::volume_error_test {
namespace {

class VolumeErrorTest : public ConvertedVolume {
 protected:
  /// Runs the command `input` with `more` options, which weir must refuse. Returns its message.
  std::string refusal(const std::vector<std::string>& input, const std::vector<std::string>& more) const {
    std::vector<std::string> all = input;
    all.insert(all.end(), {"--size", "8x6", "--spp", "1", "--backend", "cpu"});
    all.insert(all.end(), more.begin(), more.end());
    const CommandResult result = run_weir(all);
    EXPECT_EQ(result.exit_code, 2);
    return result.err;
  }
  std::string scene(const std::string& text) const {
    write_file(directory_ / "s.toml", text);
    return directory_ / "s.toml";
  }

  std::vector<std::string> render_{"render", volume_, "-o", directory_ / "a.png"};
  std::vector<std::string> play_{"play", volume_, "-o", directory_ / "frames"};
};

TEST_F(VolumeErrorTest, TooLittleMemory_NamesTheFile) {
  const std::string line = cat("weir: ", volume_,
                               ": --memory 100 B is too small to render this grid, which takes 288.1 KiB at least; "
                               "give --memory 1MiB or more\n");
  EXPECT_EQ(refusal(render_, {"--memory", "100"}), line);
  EXPECT_EQ(refusal(play_, {"--memory", "100"}), line);
}

TEST_F(VolumeErrorTest, RegionOutsideTheVolume_NamesTheFile) {
  const std::string outside = scene("[volume]\nregion = [[50, 60], [0, 9], [0, 9]]\n");
  const std::string reason =
      ": the scene's region shows no voxel of the volume, whose index box is [[0, 40], [0, 30], [0, 20]]\n";
  EXPECT_EQ(refusal(render_, {"--scene", outside}), cat("weir: ", volume_, reason));
  EXPECT_EQ(refusal(play_, {"--scene", outside}), cat("weir: ", volume_, reason));
  const std::string raw = directory_ / "v_40x30x20_float32.raw";
  EXPECT_EQ(refusal({"render", raw, "--volume", "dense", "-o", directory_ / "a.png"}, {"--scene", outside}),
            cat("weir: ", raw, reason));
}

TEST_F(VolumeErrorTest, CameraAtItsTarget_NamesTheFile) {
  const std::string standing = scene("[camera]\nposition = [1, 2, 3]\nlook_at = [1, 2, 3]\n");
  const std::string line =
      cat("weir: ", volume_, ": the camera stands at the point it looks at, (1, 2, 3); move one of them\n");
  EXPECT_EQ(refusal(render_, {"--scene", standing}), line);
  EXPECT_EQ(refusal(play_, {"--scene", standing}), line);
}

}  // namespace
}  // namespace weir::volume_error_test
