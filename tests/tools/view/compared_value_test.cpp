// The value of the other file where two that lie otherwise are compared: that of the same place, not of the same index.
#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "format/base/text.h"
#include "tests/tools/support/converted_volume.h"
#include "tests/tools/view/served_view.h"
#include "tests/tools/view/view_client.h"
#include "tools/view/value_probe.h"

namespace weir::compared_value_test {
namespace {

using Json = nlohmann::json;

// Fields x + 100 y + 10000 z of the place (x, y, z): of 64^3 voxels of edge 1, and of 32^3 or fewer of edge 2, whose
// first centre is at (0.5, 0.5, 0.5), so that 32^3 fill the same space.
class ComparedValue : public testing::Test {
 protected:
  static double field(const Double3& at) { return at[0] + 100 * at[1] + 10000 * at[2]; }

  std::string make(const std::string& name, int edge, double spacing, double origin) const {
    std::vector<float> values;
    for (int z = 0; z < edge; ++z) {
      for (int y = 0; y < edge; ++y) {
        for (int x = 0; x < edge; ++x) {
          values.push_back(
              static_cast<float>(field({origin + spacing * x, origin + spacing * y, origin + spacing * z})));
        }
      }
    }
    std::string bytes(values.size() * sizeof(float), '\0');
    std::memcpy(bytes.data(), values.data(), bytes.size());
    const std::string raw = directory_ / cat(name, "_", edge, "x", edge, "x", edge, "_float32.raw");
    write_file(raw, bytes);
    const auto three = [](double value) { return cat(value, ",", value, ",", value); };
    const CommandResult made = run_weir({"convert", raw, "-o", directory_ / name, "--lossless", "--spacing",
                                         three(spacing), "--origin", three(origin)});
    EXPECT_EQ(made.exit_code, 0) << made.err;
    return directory_ / name;
  }

  /// The answer of the voxel with the largest value of `file` along x at y = 20, z = 40 of the world.
  static Json probe(const std::string& file, const std::string& against) {
    ServedView served(file, against);
    ViewClient client(served.port());
    const std::string along_x =
        "mode = \"mip\"\n[camera]\nposition = [900, 20, 40]\nlook_at = [0, 20, 40]\nzoom = 20\n";
    client.show(1, false, {{"scene", along_x}, {"against", true}});
    client.send({{"type", "probe"}, {"id", 3}, {"x", 0.5}, {"y", 0.5}});
    return client.text("value").value();
  }

  TemporaryDirectory directory_;
  std::string fine_ = make("fine.nvdb", 64, 1, 0);
  std::string coarse_ = make("coarse.nvdb", 32, 2, 0.5);
};

TEST_F(ComparedValue, OfAnotherSpacing_IsThatOfTheSamePlace) {
  const Json answer = probe(fine_, coarse_);
  ASSERT_EQ(answer["found"], true) << answer;
  EXPECT_EQ(answer["world"], Json::parse("[63, 20, 40]"));
  EXPECT_EQ(answer["value"], field({63, 20, 40}));
  EXPECT_EQ(answer["against"], field({62.5, 20.5, 40.5})) << "of the voxel that holds the place, (31, 10, 20)";
  EXPECT_EQ(answer["outside"], false);
}

TEST_F(ComparedValue, BeyondTheOtherFilesBox_IsNone) {
  const Json answer = probe(fine_, make("corner.nvdb", 24, 2, 0.5));
  ASSERT_EQ(answer["found"], true) << answer;
  EXPECT_EQ(answer["world"], Json::parse("[63, 20, 40]"));
  EXPECT_TRUE(answer["against"].is_null()) << answer;
  EXPECT_EQ(answer["outside"], true);
}

TEST_F(ComparedValue, AtTheEdgesOfTheBox_EndsWhereItsVoxelsEnd) {
  const NvdbFile coarse(coarse_);
  EXPECT_EQ(value_at(coarse.grid(), {-0.5, -0.5, -0.5}), static_cast<float>(field({0.5, 0.5, 0.5})));
  EXPECT_EQ(value_at(coarse.grid(), {63.4, 0, 0}), static_cast<float>(field({62.5, 0.5, 0.5})));
  EXPECT_EQ(value_at(coarse.grid(), {63.5, 0, 0}), std::nullopt);
  EXPECT_EQ(value_at(coarse.grid(), {0, -0.51, 0}), std::nullopt);
  EXPECT_EQ(value_at(coarse.grid(), {0, 0, 1e300}), std::nullopt);
  EXPECT_EQ(value_at(coarse.grid(), {0, 0, std::numeric_limits<double>::quiet_NaN()}), std::nullopt);
}

TEST_F(ComparedValue, FilesThatLieOtherwise_AreNamedAtTheStart) {
  ChildProcess child({WEIR_COMMAND, "view", fine_, "--against", coarse_});
  for (int i = 0; i < 600 && child.out_so_far().find('\n') == std::string::npos; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  const std::string warning = cat(fine_, " and ", coarse_,
                                  " have other index boxes, voxel sizes or origins; each is shown where it lies in the "
                                  "world\n");
  EXPECT_NE(child.err_so_far().find(warning), std::string::npos) << child.err_so_far();
}

}  // namespace
}  // namespace weir::compared_value_test
