#include "tools/plot_canvas.h"

#include <gtest/gtest.h>

namespace weir {
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

}  // namespace
}  // namespace weir
