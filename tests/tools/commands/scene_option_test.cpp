// Tests weir convert --scene as a user runs it: the certificates of all voxels and of the visible voxels, and the
// refusal, with the scene's name, of scenes that are missing, malformed or do not say what is visible.
#include <nlohmann/json.hpp>

#include "format/base/text.h"
#include "tests/tools/support/converted_volume.h"

namespace weir::scene_option_test {
namespace {

class SceneOption : public ConvertedVolume {
 protected:
  CommandResult convert(const std::string& scene, std::vector<std::string> more = {"--psnr", "60"}) const {
    write_file(directory_.path() / "s.toml", scene);
    more.insert(more.begin(), {"convert", "v_40x30x20_float32.raw", "-o", "s.nvdb", "--scene", "s.toml", "--json"});
    CommandOptions here;
    here.directory = directory_.path();
    return run_weir(more, here);
  }
};

TEST_F(SceneOption, CertifiesAllVoxelsAndThoseSeen) {
  const CommandResult result = convert("[volume]\nrange = [0, 250]\nopacity = [[0, 0], [0.8, 0], [1, 1]]\n");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto sidecar = nlohmann::json::parse(result.out);
  EXPECT_EQ(sidecar["visible"]["scene"], "s.toml");
  // Visible are the blocks with large values (up to 249, in the rows along x from 20 on) and their neighbours.
  EXPECT_GT(sidecar["visible"]["blocks"], 20);
  EXPECT_LT(sidecar["visible"]["blocks"], 60);
  EXPECT_GE(sidecar["visible"]["psnr_db"], 60.0);
  EXPECT_LT(sidecar["visible"]["psnr_db"], 61.0) << "no better than asked";
  EXPECT_FALSE(sidecar["visible"]["lossless"]);
  EXPECT_EQ(sidecar["weir"]["options"]["scene"], "s.toml");
  const CommandResult inspected = run_weir({"inspect", directory_ / "s.nvdb"});
  EXPECT_NE(inspected.out.find("\nvisible     "), std::string::npos) << inspected.out;
  EXPECT_NE(inspected.out.find(" blocks, by s.toml: PSNR 6"), std::string::npos) << inspected.out;
  EXPECT_EQ(run_weir({"verify", directory_ / "s.nvdb"}).exit_code, 0);
}

TEST_F(SceneOption, OffByDefault) {
  EXPECT_FALSE(sidecar().visible);
  EXPECT_EQ(read_file(sidecar_path(volume_)).find("\"visible\""), std::string::npos);
}

TEST_F(SceneOption, RefusesScenesByNameAndPlace) {
  const auto refused = [&](const std::string& scene, const std::string& line) {
    const CommandResult result = convert(scene);
    EXPECT_NE(result.exit_code, 0);
    EXPECT_EQ(result.err, cat("weir: ", line, '\n'));
    EXPECT_FALSE(std::filesystem::exists(directory_.path() / "s.nvdb"));
  };
  refused("mode = \"dvr\"",
          "s.toml: nothing in it says what can be seen; give [volume] opacity and range, or region, or "
          "leave out --scene");
  refused("[volume]\nregion = [[0, 9], [0, 9]]",
          "s.toml:2:10: region must be [[x0, x1], [y0, y1], [z0, z1]], voxels, x0 inclusive, x1 exclusive");
  const CommandResult missing =
      run_weir({"convert", directory_ / "v_40x30x20_float32.raw", "--scene", directory_ / "no.toml"});
  EXPECT_EQ(missing.exit_code, 3);
  EXPECT_EQ(missing.err,
            cat("weir: ", directory_ / "no.toml", ": cannot read the scene; it must be an existing TOML file\n"));
  const CommandResult metric = convert("[volume]\nregion = [[0, 9], [0, 9], [0, 9]]", {"--preset", "paper"});
  EXPECT_EQ(metric.exit_code, 2);
  EXPECT_EQ(metric.err, "weir: --scene weighs squared errors, --metric farthest has none; use --metric sse\n");
}

}  // namespace
}  // namespace weir::scene_option_test
