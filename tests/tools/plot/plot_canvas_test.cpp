#include "tools/plot/plot_canvas.h"

#include <gtest/gtest.h>

#include <array>

#include "tests/support/message_of_error.h"
#include "tests/tools/support/chart_picture.h"

namespace weir::plot_canvas_test {
namespace {

constexpr Float3 kWhite{1, 1, 1};
constexpr Float3 kBlack{0, 0, 0};

std::unique_ptr<PlotCanvas> canvas(PlotFormat format = PlotFormat::png) {
  return make_plot_canvas(40, 20, format, kWhite);
}

TEST(PlotCanvas, ClipsWhatLiesOutside) {
  const auto sheet = canvas();
  sheet->fill(-5, -5, 2, 2, kBlack);
  sheet->text({38, 18}, "outside", 12, kBlack, TextAnchor::left);
  sheet->fill(50, 50, 60, 60, kBlack);
  const Image image = test::picture_of(sheet->finish());
  EXPECT_EQ(image.width, 40);
  EXPECT_EQ(image.height, 20);
  EXPECT_EQ(image.at(1, 1), kBlack);
  EXPECT_EQ(image.at(2, 2), kWhite);
}

TEST(PlotCanvas, LinesAreAsWideAsAsked) {
  const auto sheet = canvas();
  sheet->line({4, 10}, {16, 10}, 2, kBlack);
  const Image image = test::picture_of(sheet->finish());
  EXPECT_EQ(image.at(10, 9), kBlack);  // rows 9 and 10 lie on both sides of y = 10
  EXPECT_EQ(image.at(10, 10), kBlack);
  EXPECT_EQ(image.at(10, 8), kWhite);
  EXPECT_EQ(image.at(10, 11), kWhite);
  EXPECT_EQ(image.at(19, 10), kWhite);  // beyond the line's round end
}

TEST(PlotCanvas, PolygonsAreFilledWithinTheirOutline) {
  const auto sheet = canvas();
  sheet->polygon(std::array<PlotPoint, 4>{{{5, 5}, {15, 5}, {15, 15}, {5, 15}}}, 2, {1, 0, 0}, kBlack);
  const Image image = test::picture_of(sheet->finish());
  EXPECT_EQ(image.at(10, 10), (Float3{1, 0, 0}));
  EXPECT_EQ(image.at(10, 5), kBlack);
  EXPECT_EQ(image.at(10, 17), kWhite);
}

// Draws a text at the middle of the sheet. Returns the number of dark pixels left and right of the middle.
std::array<int, 2> dark_halves(TextAnchor anchor) {
  const auto sheet = canvas();
  sheet->text({20, 10}, "mm", 12, kBlack, anchor);
  const Image image = test::picture_of(sheet->finish());
  std::array<int, 2> dark{};
  for (std::int32_t y = 0; y < 20; ++y) {
    for (std::int32_t x = 0; x < 40; ++x) dark.at(x < 20 ? 0 : 1) += image.at(x, y).x < 0.5F ? 1 : 0;
  }
  return dark;
}

TEST(PlotCanvas, TextStandsWhereItsAnchorIs) {
  EXPECT_EQ(dark_halves(TextAnchor::left)[0], 0);
  EXPECT_GT(dark_halves(TextAnchor::left)[1], 10);
  EXPECT_EQ(dark_halves(TextAnchor::right)[1], 0);
  EXPECT_GT(dark_halves(TextAnchor::right)[0], 10);
  EXPECT_GT(dark_halves(TextAnchor::middle)[0], 5);
  EXPECT_GT(dark_halves(TextAnchor::middle)[1], 5);
  EXPECT_GT(canvas()->text_width("wide", 12), canvas()->text_width("ii", 12));
}

// A name may hold any bytes, but cairo accepts only UTF-8.
TEST(PlotCanvas, TextThatIsNoUtf8_IsDrawnWithQuestionMarks) {
  const auto drawn = [](std::string_view text) {
    const auto sheet = canvas();
    sheet->text({2, 10}, text, 12, kBlack, TextAnchor::left);
    return sheet->finish();
  };
  EXPECT_EQ(drawn("a\xef\x62"), drawn("a?b"));
  EXPECT_EQ(drawn("a\xc3"), drawn("a?"));
  EXPECT_EQ(drawn("\xed\xa0\x80"), drawn("???")) << "half a surrogate";
  EXPECT_NE(drawn("\xc3\xa9"), drawn("??")) << "a letter of two bytes";
}

TEST(PlotCanvas, SvgHasTheSheetsSize) {
  const auto sheet = canvas(PlotFormat::svg);
  sheet->line({4, 10}, {16, 10}, 2, kBlack);
  const std::string svg = sheet->finish();
  EXPECT_NE(svg.find("<svg"), std::string::npos);
  EXPECT_NE(svg.find("viewBox=\"0 0 40 20\""), std::string::npos) << svg.substr(0, 400);
  EXPECT_NE(svg.find("</svg>"), std::string::npos);
}

TEST(PlotCanvas, FormatIsTheNamesEnding) {
  EXPECT_EQ(plot_format("a/b.svg", "plot"), PlotFormat::svg);
  EXPECT_EQ(plot_format("a/b.png", "plot"), PlotFormat::png);
  EXPECT_EQ(message_of_error(ErrorKind::usage, [] { plot_format("a.jpg", "plot"); }),
            "--plot a.jpg: a chart's name must end in .png or .svg");
}

}  // namespace
}  // namespace weir::plot_canvas_test
