// Tests two compared files that lie differently: the other file shows the value of the same place, not of the same
// index, and the same clip box.
#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <limits>
#include <string>

#include "format/base/text.h"
#include "gpu/image/png_input.h"
#include "tests/tools/support/converted_volume.h"
#include "tests/tools/view/served_view.h"
#include "tests/tools/view/view_client.h"
#include "tools/view/value_probe.h"

namespace weir::compared_value_test {
namespace {

using Json = nlohmann::json;

// Fields x + 100 y + 10000 z of the place (x, y, z): 64^3 voxels of edge 1, and 32^3 or fewer of edge 2. The first
// centre of the latter is at (0.5, 0.5, 0.5), so that 32^3 fill the same space.
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

  /// Returns the answer for the voxel of the largest value on one side, along x at y = 20, z = 40 of the world.
  static Json probe(const std::string& file, const std::string& against, int side = 0, const std::string& volume = "") {
    ServedView served(file, against);
    ViewClient client(served.port());
    const std::string along_x =
        "mode = \"mip\"\n[camera]\nposition = [900, 20, 40]\nlook_at = [0, 20, 40]\nzoom = 20\n";
    client.show(1, false, {{"scene", along_x + volume}, {"against", true}});
    client.send({{"type", "probe"}, {"id", 3}, {"x", 0.5}, {"y", 0.5}, {"side", side}});
    return client.text("value").value();
  }

  /// Returns how many pixels are white in the first picture, in the second, and in only one of them. The region of
  /// `file` is white on black.
  std::array<int, 3> white_pixels(const std::string& file, const std::string& against,
                                  const std::string& region) const {
    ServedView served(file, against);
    ViewClient client(served.port());
    const std::string scene =
        "mode = \"mip\"\n[camera]\nposition = [31.5, -200, 31.5]\nlook_at = [31.5, 31.5, 31.5]\n[volume]\ncolormap = "
        "\"white\"\nopacity = [[0, 1], [1, 1]]\nregion = " +
        region + "\n";
    client.show(1, false, {{"scene", scene}, {"against", true}});
    const auto frame = client.refined(1, 16);
    EXPECT_TRUE(frame) << region;
    if (!frame) return {};
    write_file(directory_ / "seen.png", frame->picture);
    const Image seen = read_png(directory_ / "seen.png");
    const int height = seen.height / 2;
    std::array<int, 3> white{};
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < seen.width; ++x) {
        const bool first = seen.at(x, y).x > 0.5F;
        const bool second = seen.at(x, y + height).x > 0.5F;
        white[0] += first ? 1 : 0;
        white[1] += second ? 1 : 0;
        white[2] += first != second ? 1 : 0;
      }
    }
    return white;
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

TEST_F(ComparedValue, InAClipBox_IsOfTheSamePlacesOnBothSides) {
  const auto largest = [&](int side, const std::string& x) {
    return probe(fine_, coarse_, side, cat("[volume]\nregion = [", x, ", [0, 64], [0, 64]]\n"))["voxel"];
  };
  EXPECT_EQ(largest(0, "[0, 32]"), Json::parse("[31, 20, 40]"));
  EXPECT_EQ(largest(1, "[0, 32]"), Json::parse("[15, 10, 20]")) << "both end at 31.5";
  EXPECT_EQ(largest(0, "[32, 64]"), Json::parse("[63, 20, 40]"));
  EXPECT_EQ(largest(1, "[32, 64]"), Json::parse("[31, 10, 20]"));
  EXPECT_EQ(largest(1, "[7, 8]"), Json::parse("[3, 10, 20]")) << "half a voxel of it";
  EXPECT_EQ(probe(coarse_, fine_, 1, "[volume]\nregion = [[0, 16], [0, 32], [0, 32]]\n")["voxel"],
            Json::parse("[31, 20, 40]"));
}

TEST_F(ComparedValue, ClipBox_CutsBothPicturesAtTheSamePlaces) {
  const auto [all, all_of_other, apart] = white_pixels(fine_, coarse_, "[[0, 64], [0, 64], [0, 64]]");
  EXPECT_GT(all, 400);
  EXPECT_NEAR(all_of_other, all, 10);
  EXPECT_LE(apart, 10);
  for (const std::string x : {"[0, 32]", "[32, 64]"}) {
    const auto [half, half_of_other, different] = white_pixels(fine_, coarse_, cat("[", x, ", [0, 64], [0, 64]]"));
    EXPECT_NEAR(half, all / 2, 0.15 * all) << x;
    EXPECT_NEAR(half_of_other, half, 10) << x;
    EXPECT_LE(different, 10) << x;
  }
}

TEST_F(ComparedValue, ClipBoxBeyondTheOtherFile_ShowsNothingOfThat) {
  const std::string corner = make("corner.nvdb", 24, 2, 0.5);  // up to 47.5
  const std::string beyond = "[[56, 64], [0, 64], [0, 64]]";
  const auto [first, second, different] = white_pixels(fine_, corner, beyond);
  EXPECT_GT(first, 20);
  EXPECT_EQ(second, 0);
  EXPECT_EQ(different, first);
  const Json answer = probe(fine_, corner, 1, cat("[volume]\nregion = ", beyond, "\n"));
  EXPECT_EQ(answer["found"], false) << answer;
  EXPECT_FALSE(answer.contains("message")) << answer;
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
