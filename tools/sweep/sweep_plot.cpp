#include "tools/sweep/sweep_plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "format/base/text.h"
#include "tools/plot/plot_axis.h"
#include "tools/plot/plot_canvas.h"
#include "tools/plot/plot_scale.h"

namespace weir {
namespace {

constexpr std::int32_t kSheetWidth = 900;  // pixels
constexpr std::int32_t kSheetHeight = 600;
constexpr std::int32_t kSheetLeft = 112;
constexpr std::int32_t kSheetRight = 28;
constexpr std::int32_t kSheetBottom = 68;
constexpr std::int32_t kTitle = 26;       // centre of its text
constexpr std::int32_t kLegend = 56;      // centre of its first line
constexpr std::int32_t kLegendLine = 26;  // from one legend line to the next
constexpr std::int32_t kLosslessBand = 48;
constexpr double kLabelSize = 15;
constexpr double kTitleSize = 18;
constexpr double kLineWidth = 2.4;
constexpr double kMarkerRadius = 7;
constexpr Float3 kSheetPaper{1, 1, 1};
constexpr Float3 kSheetInk{0.13F, 0.13F, 0.13F};
constexpr Float3 kSheetGridLine{0.88F, 0.88F, 0.88F};

/// The marker of a method: a regular polygon, so that methods can be told apart without colours.
struct Style {
  Float3 ink;
  int corners;
  double turn;  ///< of the first corner from the right, in turns
  bool filled;
};

// Colours that colour-blind people can tell apart (M. Okabe, K. Ito, 2008), and darker ones.
constexpr std::array<Style, 10> kStyles{{{{0.000F, 0.447F, 0.698F}, 24, 0.000, true},
                                         {{0.835F, 0.369F, 0.000F}, 4, 0.125, false},
                                         {{0.000F, 0.620F, 0.451F}, 4, 0.000, false},
                                         {{0.200F, 0.200F, 0.200F}, 3, 0.750, true},
                                         {{0.800F, 0.475F, 0.655F}, 4, 0.125, true},
                                         {{0.902F, 0.624F, 0.000F}, 3, 0.250, true},
                                         {{0.337F, 0.706F, 0.914F}, 24, 0.000, false},
                                         {{0.537F, 0.314F, 0.153F}, 4, 0.000, true},
                                         {{0.439F, 0.506F, 0.098F}, 3, 0.750, false},
                                         {{0.400F, 0.200F, 0.600F}, 5, 0.250, true}}};

struct Point {
  double x;
  std::optional<double> psnr_db;  ///< nullopt: lossless
};

struct Series {
  std::string name;
  Style style;
  std::vector<Point> points;
};

// Returns whether a row can be drawn. A volume of one value that was changed has no PSNR and cannot be drawn.
bool shown(const SweepRow& row) { return row.result && (row.result->error.lossless || row.result->error.psnr_db); }

std::vector<Series> series_of(const SweepReport& report, SweepAxis axis) {
  std::vector<Series> all;
  for (const SweepRow& row : report.rows) {
    auto series = std::find_if(all.begin(), all.end(), [&](const Series& s) { return s.name == row.method; });
    if (series == all.end()) {
      series = all.insert(all.end(), {row.method, kStyles[all.size() % kStyles.size()], {}});
    }
    if (!shown(row)) continue;
    const SweepResult& r = *row.result;
    series->points.push_back({axis == SweepAxis::seconds ? r.seconds : report.bits_per_voxel(r),
                              r.error.lossless ? std::nullopt : r.error.psnr_db});
  }
  return all;
}

// Draws a marker. Its inside hides what lies below, even for a hollow marker.
void draw_marker(PlotCanvas& canvas, const PlotPoint& centre, const Style& style) {
  std::vector<PlotPoint> corners;
  for (int i = 0; i < style.corners; ++i) {
    const double angle = 2 * std::numbers::pi * (style.turn + static_cast<double>(i) / style.corners);
    corners.push_back({centre.x + kMarkerRadius * std::cos(angle), centre.y - kMarkerRadius * std::sin(angle)});
  }
  canvas.polygon(corners, kLineWidth, style.filled ? style.ink : kSheetPaper, style.ink);
}

// Draws the legend below the title, in as many lines as it needs. Returns the y below the legend.
std::int32_t draw_legend(PlotCanvas& canvas, const std::vector<Series>& all) {
  constexpr double kSample = 40;  // a piece of line with a marker, pixels
  constexpr double kGap = 28;
  double x = kSheetLeft;
  std::int32_t y = kLegend;
  for (const Series& series : all) {
    const double width = kSample + 8 + canvas.text_width(series.name, kLabelSize);
    if (x > kSheetLeft && x + width > kSheetWidth - kSheetRight) {
      x = kSheetLeft;
      y += kLegendLine;
    }
    const double middle = y;
    canvas.line({x, middle}, {x + kSample, middle}, kLineWidth, series.style.ink);
    draw_marker(canvas, {x + kSample / 2, middle}, series.style);
    canvas.text({x + kSample + 8, middle}, series.name, kLabelSize, kSheetInk, TextAnchor::left);
    x += width + kGap;
  }
  return y + kLegendLine / 2;
}

struct Frame {
  std::int32_t top;    ///< top of the axes, including the band of lossless results
  std::int32_t floor;  ///< y of the x axis
  PlotScale x;
  PlotScale psnr;
  bool band;

  PlotPoint at(const Point& p) const {
    return {x.at(p.x), p.psnr_db ? psnr.at(*p.psnr_db) : top + kLosslessBand * 0.5};
  }
};

Frame make_frame(const std::vector<Series>& all, std::int32_t top) {
  std::vector<double> x;
  std::vector<double> psnr;
  bool band = false;
  for (const Series& series : all) {
    for (const Point& point : series.points) {
      x.push_back(point.x);
      if (point.psnr_db) psnr.push_back(*point.psnr_db);
      band = band || !point.psnr_db;
    }
  }
  if (psnr.empty()) psnr = {0, 100};  // all points are in the band; the usual decibels below it
  const auto [x_min, x_max] = std::minmax_element(x.begin(), x.end());
  const auto [psnr_min, psnr_max] = std::minmax_element(psnr.begin(), psnr.end());
  constexpr std::int32_t kFloor = kSheetHeight - kSheetBottom;
  return {top, kFloor, PlotScale(decade_ticks(*x_min, *x_max), true, kSheetLeft, kSheetWidth - kSheetRight),
          PlotScale(even_ticks(*psnr_min, *psnr_max), false, kFloor, top + (band ? kLosslessBand : 0)), band};
}

void draw_axes(PlotCanvas& canvas, const Frame& frame, const std::string& x_label) {
  const auto write = [&](double x, double y, const std::string& text, TextAnchor anchor) {
    canvas.text({x, y}, text, kLabelSize, kSheetInk, anchor);
  };
  for (const double tick : frame.psnr.ticks()) {
    const std::int32_t y = frame.psnr.pixel(tick);
    canvas.fill(kSheetLeft, y, kSheetWidth - kSheetRight, y + 1, kSheetGridLine);
    write(kSheetLeft - 10, y, cat(tick), TextAnchor::right);
  }
  for (const double tick : frame.x.ticks()) {
    const std::int32_t x = frame.x.pixel(tick);
    canvas.fill(x, frame.top, x + 1, frame.floor, kSheetGridLine);
    canvas.fill(x, frame.floor, x + 2, frame.floor + 8, kSheetInk);
    const std::string label = cat(tick);
    const double half = canvas.text_width(label, kLabelSize) / 2;
    write(std::clamp<double>(x, half, kSheetWidth - half), frame.floor + 20, label, TextAnchor::middle);
  }
  for (const double tick : minor_decade_ticks(frame.x.ticks().front(), frame.x.ticks().back())) {
    const std::int32_t x = frame.x.pixel(tick);
    canvas.fill(x, frame.floor, x + 1, frame.floor + 4, kSheetInk);
  }
  if (frame.band) write(kSheetLeft - 10, frame.top + kLosslessBand / 2.0, "lossless", TextAnchor::right);
  canvas.fill(kSheetLeft - 1, frame.top, kSheetLeft + 1, frame.floor, kSheetInk);
  canvas.fill(kSheetLeft - 1, frame.floor, kSheetWidth - kSheetRight, frame.floor + 2, kSheetInk);
  canvas.text({22, (frame.top + frame.floor) / 2.0}, "PSNR (dB)", kLabelSize, kSheetInk, TextAnchor::middle, true);
  write((kSheetLeft + kSheetWidth - kSheetRight) / 2.0, kSheetHeight - 18, x_label, TextAnchor::middle);
}

}  // namespace

std::string psnr_chart(const SweepReport& report, SweepAxis axis, PlotFormat format) {
  const std::unique_ptr<PlotCanvas> sheet = make_plot_canvas(kSheetWidth, kSheetHeight, format, kSheetPaper);
  PlotCanvas& canvas = *sheet;
  const std::string file = std::filesystem::path(report.source).filename().string();
  const std::string title = report.chosen.empty() ? file : cat(file, ' ', report.chosen);
  canvas.text({kSheetLeft, kTitle}, title, kTitleSize, kSheetInk, TextAnchor::left);
  const std::vector<Series> all = series_of(report, axis);
  if (std::none_of(report.rows.begin(), report.rows.end(), shown)) {
    canvas.text({kSheetLeft, kSheetHeight / 2.0}, "no rate with a PSNR", kLabelSize, kSheetInk, TextAnchor::left);
    return canvas.finish();
  }
  const Frame frame = make_frame(all, draw_legend(canvas, all) + 32);
  draw_axes(canvas, frame, axis == SweepAxis::seconds ? "seconds" : "bits per voxel");
  for (const Series& series : all) {
    for (std::size_t i = 1; i < series.points.size(); ++i) {
      canvas.line(frame.at(series.points[i - 1]), frame.at(series.points[i]), kLineWidth, series.style.ink);
    }
  }
  for (const Series& series : all) {
    for (const Point& point : series.points) draw_marker(canvas, frame.at(point), series.style);
  }
  return canvas.finish();
}

}  // namespace weir
