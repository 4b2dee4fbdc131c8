#include "tools/sweep/sweep_plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "format/base/text.h"
#include "tools/plot/plot_axis.h"
#include "tools/plot/plot_canvas.h"

namespace weir {
namespace {

constexpr std::int32_t kSheetWidth = 900;  // pixels
constexpr std::int32_t kSheetHeight = 600;
constexpr std::int32_t kSheetLeft = 112;
constexpr std::int32_t kSheetRight = 28;
constexpr std::int32_t kSheetBottom = 68;
constexpr std::int32_t kTitle = 20;       // top of its text
constexpr std::int32_t kLegend = 56;      // centre of its first line
constexpr std::int32_t kLegendLine = 26;  // from one line of it to the next
constexpr std::int32_t kLosslessBand = 48;
constexpr std::int32_t kText = 2;      // scale of the font
constexpr std::int32_t kTextRise = 7;  // from the middle of a line of text to its top
constexpr std::size_t kTitleCharacters = 60;
constexpr float kLineWidth = 2.4F;
constexpr float kMarkerRadius = 7;
constexpr Float3 kSheetPaper{1, 1, 1};
constexpr Float3 kSheetInk{0.02F, 0.02F, 0.02F};
constexpr Float3 kSheetGridLine{0.78F, 0.78F, 0.78F};

/// How a method's points look: a regular polygon, so that methods can be told apart without colours.
struct Style {
  Float3 ink;
  int corners;
  float turn;  ///< of the first corner from the right, in turns
  bool filled;
};

// Colours that the colour-blind tell apart (M. Okabe, K. Ito, 2008), in linear light, and darker ones.
constexpr std::array<Style, 9> kStyles{{{{0.000F, 0.168F, 0.445F}, 16, 0.000F, true},
                                        {{0.665F, 0.112F, 0.000F}, 4, 0.125F, false},
                                        {{0.000F, 0.342F, 0.171F}, 4, 0.000F, false},
                                        {{0.030F, 0.030F, 0.030F}, 3, 0.750F, true},
                                        {{0.604F, 0.191F, 0.386F}, 4, 0.125F, true},
                                        {{0.791F, 0.347F, 0.000F}, 3, 0.250F, true},
                                        {{0.093F, 0.456F, 0.815F}, 16, 0.000F, false},
                                        {{0.250F, 0.080F, 0.020F}, 4, 0.000F, true},
                                        {{0.160F, 0.220F, 0.010F}, 3, 0.750F, false}}};

struct Point {
  double x;
  std::optional<double> psnr_db;  ///< none: lossless
};

struct Series {
  std::string name;
  Style style;
  std::vector<Point> points;
};

// A volume of one value, changed, has no PSNR and cannot be shown.
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

/// Where a value lies between the first tick and the last one.
class Scale {
 public:
  Scale(std::vector<double> ticks, bool logarithmic, std::int32_t first, std::int32_t last)
      : ticks_(std::move(ticks)), logarithmic_(logarithmic), first_(first), last_(last) {}

  const std::vector<double>& ticks() const { return ticks_; }
  float at(double value) const {
    const double part = (map(value) - map(ticks_.front())) / (map(ticks_.back()) - map(ticks_.front()));
    return static_cast<float>(first_ + part * (last_ - first_));
  }
  std::int32_t pixel(double value) const { return static_cast<std::int32_t>(std::lround(at(value))); }

 private:
  double map(double value) const { return logarithmic_ ? std::log10(value) : value; }

  std::vector<double> ticks_;
  bool logarithmic_;
  std::int32_t first_;
  std::int32_t last_;
};

void draw_outline(PlotCanvas& canvas, const PlotPoint& centre, const Style& style, float radius, const Float3& ink) {
  const auto corner = [&](int i) {
    const float turns = style.turn + static_cast<float>(i) / static_cast<float>(style.corners);
    const float angle = 2 * std::numbers::pi_v<float> * turns;
    return PlotPoint{centre.x + radius * std::cos(angle), centre.y - radius * std::sin(angle)};
  };
  for (int i = 0; i < style.corners; ++i) canvas.line(corner(i), corner(i + 1), kLineWidth, ink);
}

// The inside hides what lies below, of a hollow marker too.
void draw_marker(PlotCanvas& canvas, const PlotPoint& centre, const Style& style) {
  for (float radius = 0; radius < kMarkerRadius; radius += kLineWidth / 2) {
    draw_outline(canvas, centre, style, radius, style.filled ? style.ink : kSheetPaper);
  }
  draw_outline(canvas, centre, style, kMarkerRadius, style.ink);
}

// Below the title, as many lines as it needs; returns the y below it.
std::int32_t draw_legend(PlotCanvas& canvas, const std::vector<Series>& all) {
  constexpr std::int32_t kSample = 40;  // a piece of line with a marker
  constexpr std::int32_t kGap = 28;
  std::int32_t x = kSheetLeft;
  std::int32_t y = kLegend;
  for (const Series& series : all) {
    const std::int32_t width = kSample + 8 + PlotCanvas::text_width(series.name, kText);
    if (x > kSheetLeft && x + width > kSheetWidth - kSheetRight) {
      x = kSheetLeft;
      y += kLegendLine;
    }
    const auto middle = static_cast<float>(y);
    const auto left = static_cast<float>(x);
    canvas.line({left, middle}, {left + kSample, middle}, kLineWidth, series.style.ink);
    draw_marker(canvas, {left + kSample * 0.5F, middle}, series.style);
    canvas.text(x + kSample + 8, y - kTextRise, series.name, kSheetInk, kText);
    x += width + kGap;
  }
  return y + kLegendLine / 2;
}

struct Frame {
  std::int32_t top;    ///< of the axes, the band of lossless results included
  std::int32_t floor;  ///< where the x axis lies
  Scale x;
  Scale psnr;
  bool band;

  PlotPoint at(const Point& p) const {
    return {x.at(p.x), p.psnr_db ? psnr.at(*p.psnr_db) : static_cast<float>(top) + kLosslessBand * 0.5F};
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
  if (psnr.empty()) psnr = {0, 100};  // all are in the band; decibels as usual below it
  const auto [x_min, x_max] = std::minmax_element(x.begin(), x.end());
  const auto [psnr_min, psnr_max] = std::minmax_element(psnr.begin(), psnr.end());
  constexpr std::int32_t kFloor = kSheetHeight - kSheetBottom;
  return {top, kFloor, Scale(decade_ticks(*x_min, *x_max), true, kSheetLeft, kSheetWidth - kSheetRight),
          Scale(even_ticks(*psnr_min, *psnr_max), false, kFloor, top + (band ? kLosslessBand : 0)), band};
}

void draw_axes(PlotCanvas& canvas, const Frame& frame, const std::string& x_label) {
  for (const double tick : frame.psnr.ticks()) {
    const std::int32_t y = frame.psnr.pixel(tick);
    canvas.fill(kSheetLeft, y, kSheetWidth - kSheetRight, y + 1, kSheetGridLine);
    const std::string label = cat(tick);
    canvas.text(kSheetLeft - 10 - PlotCanvas::text_width(label, kText), y - kTextRise, label, kSheetInk, kText);
  }
  for (const double tick : frame.x.ticks()) {
    const std::int32_t x = frame.x.pixel(tick);
    canvas.fill(x, frame.top, x + 1, frame.floor, kSheetGridLine);
    canvas.fill(x, frame.floor, x + 2, frame.floor + 8, kSheetInk);
    const std::string label = cat(tick);
    const std::int32_t width = PlotCanvas::text_width(label, kText);
    canvas.text(std::clamp(x - width / 2, 0, kSheetWidth - width), frame.floor + 12, label, kSheetInk, kText);
  }
  for (const double tick : minor_decade_ticks(frame.x.ticks().front(), frame.x.ticks().back())) {
    const std::int32_t x = frame.x.pixel(tick);
    canvas.fill(x, frame.floor, x + 1, frame.floor + 4, kSheetInk);
  }
  if (frame.band) {
    canvas.text(kSheetLeft - 10 - PlotCanvas::text_width("lossless", kText), frame.top + kLosslessBand / 2 - kTextRise,
                "lossless", kSheetInk, kText);
  }
  canvas.fill(kSheetLeft - 1, frame.top, kSheetLeft + 1, frame.floor, kSheetInk);
  canvas.fill(kSheetLeft - 1, frame.floor, kSheetWidth - kSheetRight, frame.floor + 2, kSheetInk);
  canvas.text(8, frame.top - 22, "PSNR (dB)", kSheetInk, kText);
  const std::int32_t width = PlotCanvas::text_width(x_label, kText);
  canvas.text((kSheetLeft + kSheetWidth - kSheetRight - width) / 2, kSheetHeight - 24, x_label, kSheetInk, kText);
}

}  // namespace

Image psnr_plot(const SweepReport& report, SweepAxis axis) {
  PlotCanvas canvas(kSheetWidth, kSheetHeight, kSheetPaper);
  const std::string title = std::filesystem::path(report.source).filename().string().substr(0, kTitleCharacters);
  canvas.text(kSheetLeft, kTitle, title, kSheetInk, kText);
  const std::vector<Series> all = series_of(report, axis);
  if (std::none_of(report.rows.begin(), report.rows.end(), shown)) {
    canvas.text(kSheetLeft, kSheetHeight / 2, "no rate with a PSNR", kSheetInk, kText);
    return canvas.image();
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
  return canvas.image();
}

}  // namespace weir
