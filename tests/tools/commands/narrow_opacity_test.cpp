// Tests that convert and render warn of a scene whose opacity has a band between two entries of its table.
#include <gtest/gtest.h>

#include "format/base/text.h"
#include "tests/tools/support/converted_volume.h"

namespace weir::narrow_opacity_test {
namespace {

class NarrowOpacity : public ConvertedVolume {
 protected:
  NarrowOpacity() {
    write_file(directory_ / "band.toml",
               "mode = \"dvr\"\n[volume]\nrange = [0, 250]\n"
               "opacity = [[0, 0], [0.01526, 0], [0.01526, 1], [0.01556, 1], [0.01556, 0], [1, 0]]\n");
    write_file(directory_ / "ramp.toml", "mode = \"dvr\"\n[volume]\nrange = [0, 250]\nopacity = [[0, 0], [1, 1]]\n");
  }

  CommandResult run(const std::vector<std::string>& words) const {
    CommandOptions here;
    here.directory = directory_.path();
    return run_weir(words, here);
  }

  const std::string warning_ =
      "warning band.toml: opacity 1 at 0.01526 to 0.01556 of the range (values 3.815 to 3.89) is taken as 0, since it "
      "lies between two of the 1024 entries that the range has; give a narrower range\n";
};

TEST_F(NarrowOpacity, Convert_IsToldBeforeTheNoticeThatTheSceneShowsNothing) {
  const auto convert = [&](const std::string& scene, const std::string& output) {
    return run({"convert", "v_40x30x20_float32.raw", "-o", output, "--scene", scene, "--lossless"});
  };
  const CommandResult narrow = convert("band.toml", "n.nvdb");
  EXPECT_EQ(narrow.exit_code, 0) << narrow.err;
  const std::size_t cause = narrow.err.find(warning_);
  const std::size_t effect = narrow.err.find("n.nvdb: band.toml shows nothing of v_40x30x20_float32.raw");
  ASSERT_NE(cause, std::string::npos) << narrow.err;
  ASSERT_NE(effect, std::string::npos) << narrow.err;
  EXPECT_LT(cause, effect);
  const CommandResult wide = convert("ramp.toml", "w.nvdb");
  EXPECT_EQ(wide.exit_code, 0) << wide.err;
  EXPECT_EQ(wide.err.find("is taken as"), std::string::npos) << wide.err;
}

TEST_F(NarrowOpacity, DryRun_IsToldToo) {
  const CommandResult result =
      run({"convert", "v_40x30x20_float32.raw", "-o", "n.nvdb", "--scene", "band.toml", "--lossless", "--dry-run"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.err.find(warning_), std::string::npos) << result.err;
}

TEST_F(NarrowOpacity, Render_IsTold) {
  const auto render = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words{"render", "v.nvdb", "-o", "v.png", "--overwrite", "--size", "16x16", "--spp", "1"};
    words.insert(words.end(), more.begin(), more.end());
    const CommandResult result = run(words);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result.err;
  };
  const std::string narrow = render({"--scene", "band.toml"});
  EXPECT_NE(narrow.find(warning_), std::string::npos) << narrow;
  for (const std::vector<std::string>& words : {std::vector<std::string>{"--scene", "ramp.toml"},
                                                {"--scene", "band.toml", "--mode", "iso"},
                                                {"--mode", "dvr"}}) {
    EXPECT_EQ(render(words).find("is taken as"), std::string::npos);
  }
}

TEST_F(NarrowOpacity, Play_IsToldOnce) {
  const CommandResult result =
      run({"play", "v.nvdb", "-o", "frames", "--size", "16x16", "--spp", "1", "--scene", "band.toml"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const std::size_t first = result.err.find(warning_);
  ASSERT_NE(first, std::string::npos) << result.err;
  EXPECT_EQ(result.err.find(warning_, first + 1), std::string::npos) << result.err;
}

}  // namespace
}  // namespace weir::narrow_opacity_test
