#include "tools/report/histogram_plot.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numeric>

#include "format/base/text.h"
#include "tools/plot/plot_axis.h"
#include "tools/plot/plot_canvas.h"

namespace weir {
namespace {

constexpr std::size_t kTextColumns = 64;
constexpr int kTextRows = 10;
constexpr std::size_t kLabelWidth = 9;
constexpr std::size_t kDiscreteBins = 16;  // fewer filled bins do not show that the data are discrete

constexpr std::int32_t kWidth = 720;  // pixels
constexpr std::int32_t kHeight = 384;
constexpr std::int32_t kLeft = 64;
constexpr std::int32_t kRight = 24;
constexpr std::int32_t kTop = 56;
constexpr double kTitleMiddle = 18;
constexpr std::int32_t kBottom = 48;
constexpr double kTextSize = 12;
constexpr double kHistogramTitleSize = 15;
constexpr int kMostSteps = 6;  // of the ticks along x
constexpr Float3 kPaper{1, 1, 1};
constexpr Float3 kInk{0.2F, 0.2F, 0.2F};
constexpr Float3 kGridLine{0.88F, 0.88F, 0.88F};
constexpr Float3 kBar{0.00F, 0.45F, 0.70F};
constexpr Float3 kMark{0.84F, 0.37F, 0.00F};

bool nothing_to_show(const Sidecar::Histogram& h) {
  return !std::isfinite(h.min) || !std::isfinite(h.max) ||
         std::none_of(h.counts.begin(), h.counts.end(), [](std::uint64_t count) { return count != 0; });
}

// Returns `h` with neighbouring bins merged, the same number for every column, so that all columns are equally wide.
// First merges as many bins as lie between the values of discrete data, then as many as give at most `columns`
// columns.
Sidecar::Histogram merged(const Sidecar::Histogram& h, std::size_t columns) {
  std::size_t first = h.counts.size();
  std::size_t stride = 0;
  std::size_t filled = 0;
  for (std::size_t i = 0; i < h.counts.size(); ++i) {
    if (h.counts[i] == 0) continue;
    first = std::min(first, i);
    stride = std::gcd(stride, i - first);
    ++filled;
  }
  if (filled < kDiscreteBins) stride = 1;
  const std::size_t skipped = first % stride;  // empty bins below the first value
  const std::size_t groups = (h.counts.size() - skipped + stride - 1) / stride;
  const std::size_t per_column = stride * ((groups + columns - 1) / columns);
  const double width = (h.max - h.min) / static_cast<double>(h.counts.size());
  Sidecar::Histogram result;
  result.counts.resize((h.counts.size() - skipped + per_column - 1) / per_column);
  result.min = h.min + width * static_cast<double>(skipped);
  result.max = per_column == 1 ? h.max : result.min + width * static_cast<double>(per_column * result.counts.size());
  for (std::size_t i = first; i < h.counts.size(); ++i) result.counts[(i - skipped) / per_column] += h.counts[i];
  return result;
}

// Returns 0 for no voxel, above 0 for one voxel, 1 for `most` voxels.
double log_height(std::uint64_t count, std::uint64_t most) {
  return std::log10(1.0 + static_cast<double>(count)) / std::log10(1.0 + static_cast<double>(most));
}

std::string padded(const std::string& label) {
  return std::string(kLabelWidth - std::min(label.size(), kLabelWidth), ' ') + label;
}

}  // namespace

std::string histogram_text(const Sidecar::Histogram& histogram) {
  if (nothing_to_show(histogram)) return "histogram: no finite values\n";
  const Sidecar::Histogram shown = merged(histogram, kTextColumns);
  const auto& bins = shown.counts;
  const std::uint64_t most = *std::max_element(bins.begin(), bins.end());
  std::string plot;
  for (int row = kTextRows; row > 0; --row) {
    plot += padded(row == kTextRows ? cat(most) : row == 1 ? "1" : "") + " |";
    for (const std::uint64_t count : bins) {
      // One voxel shows: heights round up.
      plot += std::ceil(log_height(count, most) * kTextRows) >= row ? '#' : ' ';
    }
    plot.erase(plot.find_last_not_of(' ') + 1);
    plot += '\n';
  }
  plot += std::string(kLabelWidth, ' ') + " +" + std::string(bins.size(), '-') + '\n';
  const std::string low = cat(shown.min);
  const std::string high = cat(shown.max);
  const std::size_t gap = bins.size() > low.size() + high.size() ? bins.size() - low.size() - high.size() : 1;
  return plot + std::string(kLabelWidth + 2, ' ') + low + std::string(gap, ' ') + high + '\n';
}

std::string histogram_chart(const Sidecar::Histogram& histogram, std::optional<double> background,
                            const HistogramLabels& labels, PlotFormat format) {
  const std::unique_ptr<PlotCanvas> canvas = make_plot_canvas(kWidth, kHeight, format, kPaper);
  constexpr std::int32_t kFloor = kHeight - kBottom;
  constexpr std::int32_t kBarsWidth = kWidth - kLeft - kRight;
  constexpr std::int32_t kBarsHeight = kFloor - kTop;
  const auto write = [&](double x, double y, const std::string& text, TextAnchor anchor, const Float3& ink = kInk) {
    canvas->text({x, y}, text, kTextSize, ink, anchor);
  };
  canvas->text({kLeft, kTitleMiddle}, labels.title, kHistogramTitleSize, kInk, TextAnchor::left);
  if (nothing_to_show(histogram)) {
    write(kWidth / 2.0, kHeight / 2.0, "no finite values", TextAnchor::middle);
    return canvas->finish();
  }
  const Sidecar::Histogram shown = merged(histogram, static_cast<std::size_t>(kBarsWidth));
  const auto& bins = shown.counts;
  const std::uint64_t most = *std::max_element(bins.begin(), bins.end());
  const auto height = [&](std::uint64_t count) {
    return static_cast<std::int32_t>(std::lround(log_height(count, most) * kBarsHeight));
  };
  std::uint64_t decade = 1;
  for (int exponent = 0; decade <= most; ++exponent, decade *= 10) {
    const std::int32_t y = kFloor - height(decade);
    canvas->fill(kLeft, y, kWidth - kRight, y + 1, kGridLine);
    write(kLeft - 8, y, exponent < 4 ? cat(decade) : cat("1e", exponent), TextAnchor::right);
    if (decade > most / 10) break;  // the next one might not fit 64 bits
  }
  const auto columns = static_cast<std::int32_t>(bins.size());
  for (std::int32_t i = 0; i < columns; ++i) {
    const std::uint64_t count = bins[static_cast<std::size_t>(i)];
    if (count == 0) continue;
    canvas->fill(kLeft + i * kBarsWidth / columns, kFloor - std::max(height(count), 1),
                 kLeft + (i + 1) * kBarsWidth / columns, kFloor, kBar);
  }
  canvas->fill(kLeft - 1, kTop, kLeft, kFloor, kInk);
  canvas->fill(kLeft - 1, kFloor, kWidth - kRight, kFloor + 1, kInk);
  canvas->text({16, (kTop + kFloor) / 2.0}, "voxels", kTextSize, kInk, TextAnchor::middle, true);
  const double range = shown.max - shown.min;
  const auto x_of = [&](double value) {
    const double part = range > 0 ? (value - shown.min) / range : 0.5;
    return kLeft + static_cast<std::int32_t>(std::lround(part * (kBarsWidth - 1)));
  };
  const auto tick = [&](double value, const std::string& label) {
    const std::int32_t x = x_of(value);
    canvas->fill(x, kFloor, x + 1, kFloor + 5, kInk);
    const double half = canvas->text_width(label, kTextSize) / 2;
    write(std::clamp<double>(x, half, kWidth - half), kFloor + 15, label, TextAnchor::middle);
  };
  if (range > 0 && std::isfinite(range)) {
    const double step = tick_step(range, kMostSteps);
    const double first = std::ceil(shown.min / step);
    for (int i = 0; i < 8 && (first + i) * step <= shown.max; ++i) tick((first + i) * step, cat((first + i) * step));
  } else {
    tick(shown.min, cat(shown.min));
  }
  write((kLeft + kWidth - kRight) / 2.0, kHeight - 14, labels.values, TextAnchor::middle);
  if (background && *background >= shown.min && *background <= shown.max) {
    const std::int32_t x = x_of(*background);
    canvas->fill(x, kTop - 6, x + 1, kFloor, kMark);
    const std::string label = cat("background ", short_number(*background));
    const double widest = kWidth - kRight - canvas->text_width(label, kTextSize);
    write(std::min<double>(x + 5, widest), kTop - 12, label, TextAnchor::left, kMark);
  }
  return canvas->finish();
}

}  // namespace weir
