#include "tools/spectrum/spectrum_plot.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "gpu/image/colormap.h"
#include "tests/tools/support/chart_picture.h"

namespace weir::spectrum_plot_test {
namespace {

Float3 as_drawn(int red, int green, int blue) {
  const auto channel = [](int value) { return linear_from_srgb(static_cast<float>(value) / 255); };
  return {channel(red), channel(green), channel(blue)};
}
const Float3 kFile = as_drawn(0, 114, 178);
const Float3 kError = as_drawn(213, 94, 0);

Image chart_of(const PowerSpectrum& spectrum) {
  return test::picture_of(spectrum_chart(spectrum, "a.nvdb", PlotFormat::png));
}

/// Returns the first and last row with pixels of `ink` below the legend.
std::pair<std::int64_t, std::int64_t> rows_of(const Image& image, const Float3& ink) {
  std::pair<std::int64_t, std::int64_t> rows{-1, -1};
  for (std::int64_t y = 70; y < image.height; ++y) {
    const auto row = image.pixels.begin() + y * image.width;
    if (std::find(row, row + image.width, ink) == row + image.width) continue;
    if (rows.first < 0) rows.first = y;
    rows.second = y;
  }
  return rows;
}

// Shares from 1e-4 to 1 cover rows 532 to 88: 111 rows per power of ten.
TEST(SpectrumPlot, CurvesLieAtTheirShares) {
  PowerSpectrum spectrum;
  spectrum.shells = {{0.01, 1, 100, 100, 0.01}, {0.1, 1, 10, 1, 1e-3}};
  const Image image = chart_of(spectrum);
  EXPECT_EQ(image.width, 900);
  EXPECT_EQ(image.height, 600);
  const auto file = rows_of(image, kFile);
  EXPECT_NEAR(static_cast<double>(file.first), 88, 2);
  EXPECT_NEAR(static_cast<double>(file.second), 88 + 111, 2);
  const auto error = rows_of(image, kError);
  EXPECT_NEAR(static_cast<double>(error.first), 532, 2);
  EXPECT_NEAR(static_cast<double>(error.second), 532, 2);
}

TEST(SpectrumPlot, OfNoBlockIsSaidInWords) {
  const Image image = chart_of({});
  EXPECT_EQ(rows_of(image, kFile).first, -1);
  EXPECT_NE(rows_of(image, as_drawn(33, 33, 33)).first, -1);
}

}  // namespace
}  // namespace weir::spectrum_plot_test
