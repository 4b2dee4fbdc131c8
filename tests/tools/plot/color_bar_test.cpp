#include "tools/plot/color_bar.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "gpu/image/colormap.h"
#include "tests/support/message_of_error.h"
#include "tools/plot/plot_canvas.h"

namespace weir::color_bar_test {
namespace {

TransferFunction viridis(float low, float high) {
  std::vector<Rgba> table;
  for (const Float3& color : colormap("viridis", 256)) table.push_back({color.x, color.y, color.z, 1});
  return {table, low, high};
}

float distance(const Float3& a, const Float3& b) {
  return std::max({std::abs(a.x - b.x), std::abs(a.y - b.y), std::abs(a.z - b.z)});
}

int dark_pixels(const Image& image, std::int32_t from_x) {
  int dark = 0;
  for (std::int32_t y = 0; y < image.height; ++y) {
    for (std::int32_t x = from_x; x < image.width; ++x) dark += image.at(x, y).x < 0.2F ? 1 : 0;
  }
  return dark;
}

TEST(ColorBar, HasTheColoursFromTheLowestValueAtTheBottomToTheHighest) {
  const TransferFunction transfer = viridis(-2, 6);
  const Image bar = draw_color_bar(transfer, "", 360);
  EXPECT_EQ(bar.height, 360);
  EXPECT_EQ(bar.width % 8, 0);
  const std::vector<Float3> map = colormap("viridis", 256);
  for (const auto& [y, entry] : {std::pair(11, 255), std::pair(180, 127), std::pair(348, 0)}) {
    EXPECT_LT(distance(bar.at(15, y), map[static_cast<std::size_t>(entry)]), 0.02F) << y;
  }
  EXPECT_EQ(bar.at(2, 180), (Float3{1, 1, 1}));
  EXPECT_EQ(bar.at(15, 4), (Float3{1, 1, 1}));
}

TEST(ColorBar, TitleMakesItWider_AndALongOneFitsTheHeight) {
  const Image plain = draw_color_bar(viridis(0, 1), "", 200);
  const Image titled = draw_color_bar(viridis(0, 1), "T (K)", 200);
  const Image crowded = draw_color_bar(viridis(0, 1), std::string(200, 'm'), 200);
  EXPECT_GT(titled.width, plain.width);
  EXPECT_EQ(crowded.width, titled.width);
  EXPECT_GT(dark_pixels(titled, plain.width - 8), 5);
  for (std::int32_t x = 0; x < crowded.width; ++x) EXPECT_EQ(crowded.at(x, 0), (Float3{1, 1, 1}));
}

TEST(ColorBar, OneValueAndHugeOnesHaveNumbers) {
  EXPECT_GT(dark_pixels(draw_color_bar(viridis(5, 5), "", 100), 30), 0);
  EXPECT_GT(dark_pixels(draw_color_bar(viridis(-3e38F, 3e38F), "", 100), 30), 0);
  EXPECT_GT(dark_pixels(draw_color_bar(viridis(1e-30F, 1.1e-30F), "", 64), 30), 0);
}

TEST(ColorBar, OneValue_IsNotRoundedToAWholeNumber) {
  EXPECT_NE(draw_color_bar(viridis(3.5F, 3.5F), "", 100).pixels, draw_color_bar(viridis(4, 4), "", 100).pixels);
  EXPECT_NE(draw_color_bar(viridis(25.7F, 25.7F), "", 100).pixels, draw_color_bar(viridis(26, 26), "", 100).pixels);
}

TEST(ColorBar, WithRoomForItsEndsAlone_NamesThemToAHundredth) {
  EXPECT_NE(draw_color_bar(viridis(0.34F, 1.26F), "", 64).pixels, draw_color_bar(viridis(0.33F, 1.27F), "", 64).pixels);
}

TEST(ColorBar, OfAPictureThatIsTooLow_IsRefused) {
  EXPECT_EQ(message_of_error(ErrorKind::usage, [] { draw_color_bar(viridis(0, 1), "", 63); }),
            "--colorbar needs a picture of at least 64 pixels in height, this one has 63");
}

TEST(ColorBar, BesideAPicture_ItKeepsThePicturesBytesAndNotes) {
  Picture picture;
  picture.image = Image(3, 70);
  for (std::size_t i = 0; i < picture.image.pixels.size(); ++i) {
    const auto v = static_cast<float>(i) / 50;
    picture.image.pixels[i] = {v, 2 - v, 0.5F};
  }
  picture.tone = {1.3F, true};
  picture.finest_level = 2;
  picture.levels_note = "coarse";
  picture.memory_note = "little";
  const Image bar = draw_color_bar(viridis(0, 1), "", 70);
  const Picture both = with_color_bar(picture, bar);
  ASSERT_EQ(both.image.width, 3 + bar.width);
  EXPECT_EQ(both.finest_level, 2);
  EXPECT_EQ(both.levels_note, "coarse");
  EXPECT_EQ(both.memory_note, "little");
  const auto before = encode_rgb24(picture.image, picture.tone);
  const auto after = encode_rgb24(both.image, both.tone);
  for (std::size_t y = 0; y < 70; ++y) {
    for (std::size_t i = 0; i < 9; ++i) {
      EXPECT_EQ(after[y * 3 * static_cast<std::size_t>(both.image.width) + i], before[9 * y + i]);
    }
  }
}

}  // namespace
}  // namespace weir::color_bar_test
