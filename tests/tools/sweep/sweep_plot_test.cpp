#include "tools/sweep/sweep_plot.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "gpu/image/colormap.h"
#include "tests/tools/support/chart_picture.h"

namespace weir::sweep_plot_test {
namespace {

constexpr Float3 kPaper{1, 1, 1};

Image psnr_plot(const SweepReport& report, SweepAxis axis) {
  return test::picture_of(psnr_chart(report, axis, PlotFormat::png));
}

// A report of 10^3 voxels, so that 125 bytes are one bit per voxel.
SweepReport report_of(const std::vector<SweepRow>& rows) {
  SweepReport report;
  report.source = "some/where/volume_10x10x10_uint8.raw";
  report.extent = {10, 10, 10};
  report.rows = rows;
  return report;
}

SweepRow row(const std::string& method, std::uint64_t bytes, std::optional<double> psnr_db, double seconds = 1) {
  Certificate error;
  error.psnr_db = psnr_db;
  error.lossless = !psnr_db;
  return {method, 8, bytes, SweepResult{"fpn", bytes, error, seconds, 1}, ""};
}

SweepRow unmet(const std::string& method) { return {method, 100, 10, std::nullopt, "too small"}; }

Float3 ink_of(int red, int green, int blue) {
  const auto channel = [](int value) { return linear_from_srgb(static_cast<float>(value) / 255); };
  return {channel(red), channel(green), channel(blue)};
}

std::int64_t pixels_of(const Image& image, const Float3& ink) {
  return std::count(image.pixels.begin(), image.pixels.end(), ink);
}

// The axes of this chart: x from 1 to 10 bits over pixels 112 to 872, PSNR from 20 to 100 dB over 532 to 101.
TEST(SweepPlot, PointsAreDrawnAtTheirValues) {
  const Image image = psnr_plot(report_of({row("auto", 125, 20), row("auto", 1250, 100)}), SweepAxis::bits_per_voxel);
  EXPECT_EQ(image.width, 900);
  EXPECT_EQ(image.height, 600);
  const Float3 ink = image.at(112, 532);  // the first marker's middle
  EXPECT_NE(ink, kPaper);
  EXPECT_EQ(image.at(872, 101), ink);
  EXPECT_EQ(image.at(492, 316), ink);  // half way between, on the line
  EXPECT_EQ(image.at(800, 400), kPaper);
}

TEST(SweepPlot, SecondsCanBeTheAxis) {
  const auto report = report_of({row("auto", 125, 20, 0.01), row("auto", 125, 100, 0.1)});
  const Image image = psnr_plot(report, SweepAxis::seconds);
  EXPECT_EQ(image.at(112, 532), image.at(872, 101));
  EXPECT_NE(psnr_plot(report, SweepAxis::bits_per_voxel).pixels, image.pixels);
}

TEST(SweepPlot, LosslessRowsAreDrawnInABandOfTheirOwn) {
  const Image image = psnr_plot(report_of({row("auto", 125, 20), row("auto", 250, 100), row("auto", 1250, {})}),
                                SweepAxis::bits_per_voxel);
  const Float3 ink = image.at(112, 532);
  EXPECT_EQ(image.at(872, 101 + 24), ink);  // the band's middle
  EXPECT_EQ(
      image.at(872, 101 + 2),
      psnr_plot(report_of({row("auto", 125, 20), row("auto", 1250, 20)}), SweepAxis::bits_per_voxel).at(872, 103));
  const Image only = psnr_plot(report_of({row("auto", 125, {}), row("auto", 1250, {})}), SweepAxis::bits_per_voxel);
  EXPECT_EQ(only.at(112, 125), ink);
  EXPECT_EQ(only.at(872, 125), ink);
}

TEST(SweepPlot, UnmetRatesAreLeftOutOfTheLineButNotOfTheLegend) {
  const Image with =
      psnr_plot(report_of({unmet("auto"), row("auto", 125, 20), row("auto", 1250, 100)}), SweepAxis::bits_per_voxel);
  const Image without = psnr_plot(report_of({row("auto", 125, 20), row("auto", 1250, 100)}), SweepAxis::bits_per_voxel);
  EXPECT_EQ(with.pixels, without.pixels);
  const Image other =
      psnr_plot(report_of({row("auto", 125, 20), row("auto", 1250, 100), unmet("zfp")}), SweepAxis::bits_per_voxel);
  EXPECT_NE(other.pixels, without.pixels);
}

TEST(SweepPlot, MethodsHaveDifferentColours) {
  std::vector<SweepRow> rows;
  for (const char* name : {"auto", "fpn", "float", "fp4", "fp8", "fp16", "paper", "paper32", "zfp", "packed"}) {
    rows.push_back(row(name, 125, 20.0 + 10.0 * static_cast<double>(rows.size())));
  }
  const Image image = psnr_plot(report_of(rows), SweepAxis::bits_per_voxel);
  EXPECT_GT(pixels_of(image, ink_of(0, 114, 178)), 50);
  EXPECT_GT(pixels_of(image, ink_of(112, 129, 25)), 10);  // the ninth, in the legend's second line
  EXPECT_GT(pixels_of(image, ink_of(102, 51, 153)), 10);
}

// Ranges with ticks that could loop, divide by zero or overflow, and volumes with nothing to show.
TEST(SweepPlot, Extremes) {
  SweepRow no_psnr = row("auto", 125, 20);
  no_psnr.result->error.psnr_db.reset();
  for (const auto& rows : {std::vector<SweepRow>{},
                           {unmet("auto")},
                           {no_psnr},
                           {row("auto", 125, 0)},
                           {row("auto", 125, 20, 1e-9), row("auto", 1, 20, 1e9)},
                           {row("auto", 125, -700), row("zfp", std::uint64_t{1} << 62U, 1e4)},
                           {row("auto", 125, 41.123456789), row("auto", 126, 41.123456790)}}) {
    for (const SweepAxis axis : {SweepAxis::bits_per_voxel, SweepAxis::seconds}) {
      EXPECT_EQ(psnr_plot(report_of(rows), axis).pixels.size(), 900U * 600U);
    }
  }
}

}  // namespace
}  // namespace weir::sweep_plot_test
