#include "tools/report/histogram_plot.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/tools/support/chart_picture.h"

namespace weir::histogram_plot_test {
namespace {

TEST(HistogramText, IsLogarithmicAndShowsASingleVoxel) {
  EXPECT_EQ(histogram_text({0, 4, {1000, 0, 1, 30}}),
            "     1000 |#\n"
            "          |#\n"
            "          |#\n"
            "          |#\n"
            "          |#\n"
            "          |#  #\n"
            "          |#  #\n"
            "          |#  #\n"
            "          |# ##\n"
            "        1 |# ##\n"
            "          +----\n"
            "           0  4\n");
}

TEST(HistogramText, MergesToAtMost64ColumnsOfEqualWidth) {
  Sidecar::Histogram histogram{0, 130, std::vector<std::uint64_t>(130, 5)};
  const std::string text = histogram_text(histogram);
  EXPECT_EQ(text.substr(0, text.find('\n')), "       15 |" + std::string(43, '#'));  // the 44th holds one bin
}

TEST(HistogramText, DiscreteDataHasNoGaps) {
  Sidecar::Histogram histogram{0, 16.25, std::vector<std::uint64_t>(65, 0)};
  for (std::size_t i = 0; i < histogram.counts.size(); i += 4) histogram.counts[i] = 7;
  const std::string text = histogram_text(histogram);
  EXPECT_EQ(text.substr(0, text.find('\n')), "        7 |" + std::string(17, '#'));
  EXPECT_EQ(text.substr(text.rfind('\n', text.size() - 2) + 1), "           0              17\n");
}

TEST(HistogramText, FewFilledBinsAreNotTakenForDiscreteData) {
  const std::string text = histogram_text({0, 1, {9, 0, 0, 0, 9}});
  EXPECT_EQ(text.substr(0, text.find('\n')), "        9 |#   #");
}

TEST(HistogramText, NoFiniteValues_IsSaid) {
  const std::string nothing = "histogram: no finite values\n";
  EXPECT_EQ(histogram_text({}), nothing);
  EXPECT_EQ(histogram_text({0, 1, {0, 0}}), nothing);
  EXPECT_EQ(histogram_text({std::nan(""), 1, {1}}), nothing);
}

TEST(HistogramText, OneBinOfAConstantVolume) {
  EXPECT_EQ(histogram_text({0.5, 0.5, {512}}).substr(0, 13), "      512 |#\n");
}

Float3 pixel(const Image& image, std::int32_t x, std::int32_t y) { return image.at(x, y); }

Image histogram_image(const Sidecar::Histogram& histogram, std::optional<double> background) {
  return test::picture_of(histogram_chart(histogram, background, {"t.raw", "value"}, PlotFormat::png));
}

TEST(HistogramImage, BarsStandWhereTheCountsAre) {
  // Two of four bins over the plot's 632 pixels from x = 64; the floor is at y = 336.
  const Image image = histogram_image({0, 4, {100, 0, 0, 100}}, std::nullopt);
  EXPECT_EQ(image.width, 720);
  EXPECT_EQ(image.height, 384);
  const Float3 bar = pixel(image, 80, 200);
  EXPECT_LT(bar.x, 0.5F);
  EXPECT_EQ(pixel(image, 680, 200), bar);
  EXPECT_EQ(pixel(image, 360, 308), (Float3{1, 1, 1}));
}

TEST(HistogramImage, MarksTheBackgroundOnlyWithinTheRange) {
  const Image without = histogram_image({0, 4, {100, 0, 0, 100}}, std::nullopt);
  const Image with = histogram_image({0, 4, {100, 0, 0, 100}}, 2.0);
  const Image outside = histogram_image({0, 4, {100, 0, 0, 100}}, 5.0);
  EXPECT_NE(pixel(with, 64 + 316, 200), pixel(without, 64 + 316, 200));
  EXPECT_EQ(outside.pixels, without.pixels);
}

TEST(HistogramImage, HasTitleAndUnits) {
  const auto dark = [](const std::string& title, const std::string& values, std::int32_t y0, std::int32_t y1) {
    const Image image =
        test::picture_of(histogram_chart({0, 4, {1, 1}}, std::nullopt, {title, values}, PlotFormat::png));
    std::int64_t count = 0;
    for (std::int32_t y = y0; y < y1; ++y) {
      for (std::int32_t x = 0; x < image.width; ++x) count += pixel(image, x, y).x < 0.5F ? 1 : 0;
    }
    return count;
  };
  EXPECT_EQ(dark("", "", 5, 30), 0);
  EXPECT_GT(dark("run.h5 /qc at 2", "", 5, 30), 100);
  EXPECT_EQ(dark("", "", 362, 380), 0);
  EXPECT_GT(dark("", "qc (kg kg-1)", 362, 380), 50);
}

// Ranges whose ticks could loop, divide by zero or overflow.
TEST(HistogramImage, SurvivesExtremeRanges) {
  const double big = 1e300;
  for (const Sidecar::Histogram& h :
       {Sidecar::Histogram{big, std::nextafter(big, 2 * big), {1, 2}}, Sidecar::Histogram{0, 5e-324, {1, 2}},
        Sidecar::Histogram{-1.7e308, 1.7e308, {1, 2}}, Sidecar::Histogram{1e8, 1e8 + 1e-3, {1, 2}},
        Sidecar::Histogram{0, 1, {std::numeric_limits<std::uint64_t>::max(), 1}}, Sidecar::Histogram{}}) {
    EXPECT_EQ(histogram_image(h, h.min).pixels.size(), 720U * 384U);
  }
}

}  // namespace
}  // namespace weir::histogram_plot_test
