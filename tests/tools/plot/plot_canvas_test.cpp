#include "tools/plot/plot_canvas.h"

#include <gtest/gtest.h>

namespace weir::plot_canvas_test {
namespace {

TEST(PlotCanvas, ClipsWhatLiesOutside) {
  PlotCanvas canvas(10, 10, {1, 1, 1});
  canvas.fill(-5, -5, 2, 2, {0, 0, 0});
  canvas.text(7, 7, "88", {0, 0, 0});
  canvas.fill(20, 20, 30, 30, {0, 0, 0});
  EXPECT_EQ(canvas.image().at(1, 1), (Float3{0, 0, 0}));
  EXPECT_EQ(canvas.image().at(2, 2), (Float3{1, 1, 1}));
  EXPECT_EQ(canvas.image().at(8, 7), (Float3{0, 0, 0}));  // the top of the first 8
  EXPECT_EQ(PlotCanvas::text_width("1e4"), 17);
}

TEST(PlotCanvas, LinesAreSmoothAndAsWideAsAsked) {
  PlotCanvas canvas(20, 20, {1, 1, 1});
  canvas.line({4, 10}, {16, 10}, 2, {0, 0, 0});
  EXPECT_EQ(canvas.image().at(10, 9), (Float3{0, 0, 0}));  // rows 9 and 10 lie on both sides of y = 10
  EXPECT_EQ(canvas.image().at(10, 10), (Float3{0, 0, 0}));
  EXPECT_EQ(canvas.image().at(10, 8), (Float3{1, 1, 1}));
  EXPECT_EQ(canvas.image().at(10, 11), (Float3{1, 1, 1}));
  EXPECT_EQ(canvas.image().at(19, 10), (Float3{1, 1, 1}));  // past the round end
  PlotCanvas half(20, 20, {1, 1, 1});
  half.line({4, 10.5F}, {16, 10.5F}, 2, {0, 0, 0});
  EXPECT_EQ(half.image().at(10, 10), (Float3{0, 0, 0}));
  EXPECT_EQ(half.image().at(10, 9), (Float3{0.5F, 0.5F, 0.5F}));
}

TEST(PlotCanvas, ALineOfNoLengthIsADiscAndIsClipped) {
  PlotCanvas canvas(10, 10, {1, 1, 1});
  canvas.line({0, 0}, {0, 0}, 8, {0, 0, 0});
  canvas.line({-50, -50}, {-40, -50}, 8, {0, 0, 0});
  EXPECT_EQ(canvas.image().at(0, 0), (Float3{0, 0, 0}));
  EXPECT_EQ(canvas.image().at(1, 1), (Float3{0, 0, 0}));
  EXPECT_EQ(canvas.image().at(4, 4), (Float3{1, 1, 1}));
}

TEST(PlotCanvas, TextScales) {
  PlotCanvas canvas(40, 40, {1, 1, 1});
  canvas.text(0, 0, "L", {0, 0, 0}, 3);
  EXPECT_EQ(canvas.image().at(2, 20), (Float3{0, 0, 0}));
  EXPECT_EQ(canvas.image().at(3, 0), (Float3{1, 1, 1}));
  EXPECT_EQ(canvas.image().at(14, 18), (Float3{0, 0, 0}));
  EXPECT_EQ(PlotCanvas::text_width("1e4", 2), 34);
  // Descenders reach below the line that others stand on.
  PlotCanvas small(10, 10, {1, 1, 1});
  small.text(0, 0, "p", {0, 0, 0});
  EXPECT_EQ(small.image().at(0, 8), (Float3{0, 0, 0}));
  EXPECT_EQ(small.image().at(0, 1), (Float3{1, 1, 1}));
}

}  // namespace
}  // namespace weir::plot_canvas_test
