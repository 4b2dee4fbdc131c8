// Tests weir flip as a user runs it.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "gpu/image/colormap.h"
#include "gpu/image/flip.h"
#include "gpu/image/image_output.h"
#include "gpu/image/png_input.h"
#include "tests/support/run_command.h"

namespace weir::flip_test {
namespace {

class FlipCommand : public ::testing::Test {
 protected:
  /// Writes a PNG with the sRGB value `left` (0 to 255) in the left half and `right` in the right half. Returns its
  /// path.
  std::string picture(const std::string& name, std::int32_t width, std::int32_t height, int left, int right) const {
    Image image(width, height);
    for (std::int32_t y = 0; y < height; ++y) {
      for (std::int32_t x = 0; x < width; ++x) {
        const float v = linear_from_srgb(static_cast<float>(2 * x < width ? left : right) / 255.0F);
        image.pixels[image.index(x, y)] = {v, v, v};
      }
    }
    const std::vector<std::byte> bytes = encode_png(image, {.exposure = 1, .soft_clip = false});
    write_file(directory_ / name, std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
    return directory_ / name;
  }
  void expect_refused(const std::vector<std::string>& arguments, int exit_code, const std::string& line) const {
    const std::vector<std::string> before = list_directory(directory_.path());
    const CommandResult result = run_weir(arguments);
    EXPECT_EQ(result.exit_code, exit_code);
    EXPECT_EQ(result.err, "weir: " + line + "\n");
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(list_directory(directory_.path()), before);
  }

  TemporaryDirectory directory_;
};

TEST_F(FlipCommand, WritesAJsonReportAndAnErrorMap) {
  const std::string a = picture("a.png", 60, 40, 40, 200);
  const std::string b = picture("b.png", 60, 40, 40, 190);
  const CommandResult result = run_weir({"flip", a, b, "--json", "-o", directory_ / "map.png"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err, "");
  const auto report = nlohmann::json::parse(result.out);
  const std::vector<float> errors = flip_errors(read_png(a), read_png(b), kFlipPixelsPerDegree);
  const FlipSummary expected = summarise_flip(errors);
  EXPECT_EQ(report["reference"], a);
  EXPECT_EQ(report["test"], b);
  EXPECT_EQ(report["width"], 60);
  EXPECT_EQ(report["height"], 40);
  EXPECT_EQ(report["pixels_per_degree"], kFlipPixelsPerDegree);
  EXPECT_EQ(report["mean"], expected.mean);
  EXPECT_EQ(report["median"], expected.median);
  EXPECT_EQ(report["weighted_median"], expected.weighted_median);
  EXPECT_EQ(report["first_weighted_quartile"], expected.first_weighted_quartile);
  EXPECT_EQ(report["third_weighted_quartile"], expected.third_weighted_quartile);
  EXPECT_EQ(report["min"], 0);  // pixels far from the changed half have no error
  EXPECT_EQ(report["max"], expected.max);
  EXPECT_GT(report["total_s"], 0);
  EXPECT_EQ(report.size(), 13U);

  const Image map = read_png(directory_ / "map.png");
  const Image drawn = flip_picture(errors, 60, 40);
  for (std::size_t i = 0; i < map.pixels.size(); ++i) {  // the pictures differ by the rounding to 8 bits at most
    ASSERT_NEAR(srgb_from_linear(map.pixels[i].x), srgb_from_linear(drawn.pixels[i].x), 0.501F / 255);
    ASSERT_NEAR(srgb_from_linear(map.pixels[i].z), srgb_from_linear(drawn.pixels[i].z), 0.501F / 255);
  }
  EXPECT_EQ(list_directory(directory_.path()), (std::vector<std::string>{"a.png", "b.png", "map.png"}));
}

TEST_F(FlipCommand, PrintsAReadableSummary) {
  const std::string black = picture("black.png", 24, 16, 0, 0);
  const std::string white = picture("white.png", 24, 16, 255, 255);
  EXPECT_EQ(run_weir({"flip", black, black}).out,
            "mean                     0\nmedian                   0\nweighted median          0\n"
            "1st weighted quartile    0\n3rd weighted quartile    0\nmin                      0\nmax                   "
            "   0\n");
  const CommandResult result = run_weir({"flip", black, white});
  EXPECT_EQ(result.out.rfind("mean                     0.9674", 0), 0U) << result.out;
}

TEST_F(FlipCommand, ColorBar_StandsBesideTheMapThatIsAsWithoutIt) {
  const std::string a = picture("a.png", 64, 80, 100, 110);
  const std::string b = picture("b.png", 64, 80, 110, 100);
  ASSERT_EQ(run_weir({"flip", a, b, "-o", directory_ / "map.png"}).exit_code, 0);
  const CommandResult result = run_weir({"flip", a, b, "-o", directory_ / "bar.png", "--colorbar"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const Image plain = read_png(directory_ / "map.png");
  const Image both = read_png(directory_ / "bar.png");
  ASSERT_GT(both.width, 64 + 30);
  for (std::int32_t y = 0; y < 80; ++y) {
    for (std::int32_t x = 0; x < 64; ++x) ASSERT_EQ(both.at(x, y), plain.at(x, y));
  }
  EXPECT_EQ(run_weir({"flip", a, b, "--colorbar"}).exit_code, 2);
}

TEST_F(FlipCommand, FewerPixelsPerDegree_GiveALargerError) {
  const std::string a = picture("a.png", 64, 20, 100, 110);
  const std::string b = picture("b.png", 64, 20, 110, 100);
  const auto mean = [&](const std::string& ppd) {
    return nlohmann::json::parse(run_weir({"flip", a, b, "--json", "--ppd", ppd}).out)["mean"].get<double>();
  };
  EXPECT_GT(mean("20"), mean("300"));
}

TEST_F(FlipCommand, Refusals) {
  const std::string a = picture("a.png", 6, 4, 0, 9);
  const std::string b = picture("b.png", 4, 6, 0, 9);
  expect_refused({"flip", a, b, "-o", directory_ / "map.png"}, 2,
                 b + ": 4 x 6 pixels, but " + a + " has 6 x 4; give two pictures of one size");
  expect_refused({"flip", a, a, "--ppd", "0"}, 2, "--ppd is 0, it must be from 1 to 1000");
  expect_refused({"flip", a, a, "--ppd", "nan"}, 2, "--ppd is nan, it must be from 1 to 1000");
  expect_refused({"flip", a, a, "-o", directory_ / "map.exr"}, 2,
                 "--output is \"" + (directory_ / "map.exr") + "\", it must end in .png");
  expect_refused({"flip", a, directory_ / "none.png"}, 3,
                 (directory_ / "none.png") + ": cannot open: No such file or directory");
  write_file(directory_ / "no.png", "GIF89a");
  expect_refused({"flip", directory_ / "no.png", a}, 3,
                 (directory_ / "no.png") + ": not a PNG file; give a picture as .png");
  write_file(directory_ / "map.png", "precious");
  expect_refused({"flip", a, a, "-o", directory_ / "map.png"}, 2,
                 (directory_ / "map.png") + ": exists; choose another output or pass --overwrite");
  EXPECT_EQ(read_file(directory_ / "map.png"), "precious");
  EXPECT_EQ(run_weir({"flip", a, a, "-o", directory_ / "map.png", "--overwrite"}).exit_code, 0);
  EXPECT_EQ(read_png(directory_ / "map.png").width, 6);
  expect_refused({"flip", a, a, "-o", directory_ / "no/map.png"}, 5,
                 (directory_ / "no/map.png") + ": the directory " + (directory_ / "no") +
                     " does not exist; make it or choose another output");
}

TEST_F(FlipCommand, OutputThatIsAnInput_IsRefused) {
  const std::string a = picture("a.png", 6, 4, 0, 9);
  const std::string b = picture("b.png", 6, 4, 0, 8);
  const std::string before = read_file(a);
  std::filesystem::create_symlink(b, directory_ / "c.png");
  for (const std::string& output : {a, b, directory_ / "c.png"}) {
    expect_refused({"flip", a, b, "-o", output, "--overwrite"}, 2,
                   output + ": belongs to the input, and writing " + output +
                       " would replace or remove it; choose another output");
  }
  EXPECT_EQ(read_file(a), before);
}

}  // namespace
}  // namespace weir::flip_test
