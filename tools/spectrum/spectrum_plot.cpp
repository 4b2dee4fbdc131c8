#include "tools/spectrum/spectrum_plot.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "format/base/text.h"
#include "tools/plot/plot_axis.h"
#include "tools/plot/plot_scale.h"

namespace weir {
namespace {

constexpr std::int32_t kSpectrumWidth = 900;  // pixels
constexpr std::int32_t kSpectrumHeight = 600;
constexpr std::int32_t kSpectrumLeft = 112;
constexpr std::int32_t kSpectrumRight = kSpectrumWidth - 28;
constexpr std::int32_t kSpectrumTop = 88;
constexpr std::int32_t kSpectrumBottom = kSpectrumHeight - 68;
constexpr double kLabels = 15;
constexpr double kLine = 2.4;
constexpr Float3 kSpectrumPaper{1, 1, 1};
constexpr Float3 kSpectrumInk{0.13F, 0.13F, 0.13F};
constexpr Float3 kSpectrumGridLine{0.88F, 0.88F, 0.88F};
// Colours that colour-blind people can tell apart (M. Okabe, K. Ito, 2008).
constexpr Float3 kKept{0.000F, 0.447F, 0.698F};
constexpr Float3 kLost{0.835F, 0.369F, 0.000F};
/// Smaller shares are drawn at this value.
constexpr double kLeastShare = 1e-16;

struct PowerShare {
  double wave_number;
  double value;
};

std::vector<PowerShare> shares(const PowerSpectrum& spectrum, double PowerSpectrum::Shell::*power) {
  std::vector<PowerShare> all;
  for (const PowerSpectrum::Shell& shell : spectrum.shells) {
    if (shell.source > 0) all.push_back({shell.wave_number, std::max(shell.*power / shell.source, kLeastShare)});
  }
  return all;
}

// Returns the label of `tick`, a power of ten.
std::string share_text(double tick) {
  const long exponent = std::lround(std::log10(tick));
  return exponent == 0 ? "1" : exponent == 1 ? "10" : cat("1e", exponent);
}

// Returns powers of ten around all values and around 1, which is all of the source's power.
std::vector<double> share_ticks(const std::vector<PowerShare>& kept, const std::vector<PowerShare>& lost) {
  double low = 1;
  double high = 1;
  for (const auto* all : {&kept, &lost}) {
    for (const PowerShare& share : *all) {
      low = std::min(low, share.value);
      high = std::max(high, share.value);
    }
  }
  const auto first = static_cast<int>(std::floor(std::log10(low)));
  const int last = std::max(static_cast<int>(std::ceil(std::log10(high))), first + 1);
  const int step = (last - first) / 10 + 1;
  std::vector<double> ticks;
  for (int exponent = first; exponent < last + step; exponent += step) ticks.push_back(std::pow(10, exponent));
  return ticks;
}

void draw_axes(PlotCanvas& canvas, const PlotScale& x, const PlotScale& y) {
  const auto write = [&](double at_x, double at_y, const std::string& text, TextAnchor anchor) {
    canvas.text({at_x, at_y}, text, kLabels, kSpectrumInk, anchor);
  };
  for (const double tick : y.ticks()) {
    canvas.fill(kSpectrumLeft, y.pixel(tick), kSpectrumRight, y.pixel(tick) + 1, kSpectrumGridLine);
    write(kSpectrumLeft - 10, y.pixel(tick), share_text(tick), TextAnchor::right);
  }
  for (const double tick : x.ticks()) {
    const std::int32_t at = x.pixel(tick);
    canvas.fill(at, kSpectrumTop, at + 1, kSpectrumBottom, kSpectrumGridLine);
    const std::string label = cat(tick);
    const double half = canvas.text_width(label, kLabels) / 2;
    write(std::clamp<double>(at, half, kSpectrumWidth - half), kSpectrumBottom + 20, label, TextAnchor::middle);
  }
  for (const double tick : minor_decade_ticks(x.ticks().front(), x.ticks().back())) {
    canvas.fill(x.pixel(tick), kSpectrumBottom, x.pixel(tick) + 1, kSpectrumBottom + 4, kSpectrumInk);
  }
  canvas.fill(kSpectrumLeft - 1, kSpectrumTop, kSpectrumLeft + 1, kSpectrumBottom, kSpectrumInk);
  canvas.fill(kSpectrumLeft - 1, kSpectrumBottom, kSpectrumRight, kSpectrumBottom + 2, kSpectrumInk);
  canvas.text({22, (kSpectrumTop + kSpectrumBottom) / 2.0}, "share of the source's power", kLabels, kSpectrumInk,
              TextAnchor::middle, true);
  write((kSpectrumLeft + kSpectrumRight) / 2.0, kSpectrumHeight - 18, "wave number (cycles per world unit)",
        TextAnchor::middle);
}

void draw_curve(PlotCanvas& canvas, const PlotScale& x, const PlotScale& y, const std::vector<PowerShare>& all,
                const Float3& ink) {
  const auto point = [&](const PowerShare& share) { return PlotPoint{x.at(share.wave_number), y.at(share.value)}; };
  for (std::size_t i = 1; i < all.size(); ++i) canvas.line(point(all[i - 1]), point(all[i]), kLine, ink);
}

void draw_legend(PlotCanvas& canvas) {
  double x = kSpectrumLeft;
  constexpr double kMiddle = 56;
  for (const auto& [name, ink] : {std::pair{"the file", kKept}, std::pair{"its error", kLost}}) {
    canvas.line({x, kMiddle}, {x + 40, kMiddle}, kLine, ink);
    canvas.text({x + 48, kMiddle}, name, kLabels, kSpectrumInk, TextAnchor::left);
    x += 48 + canvas.text_width(name, kLabels) + 28;
  }
}

}  // namespace

std::string spectrum_chart(const PowerSpectrum& spectrum, const std::string& title, PlotFormat format) {
  const std::unique_ptr<PlotCanvas> sheet = make_plot_canvas(kSpectrumWidth, kSpectrumHeight, format, kSpectrumPaper);
  PlotCanvas& canvas = *sheet;
  canvas.text({kSpectrumLeft, 26}, title, 18, kSpectrumInk, TextAnchor::left);
  const std::vector<PowerShare> kept = shares(spectrum, &PowerSpectrum::Shell::decoded);
  const std::vector<PowerShare> lost = shares(spectrum, &PowerSpectrum::Shell::error);
  if (kept.empty()) {
    canvas.text({kSpectrumLeft, kSpectrumHeight / 2.0}, "no block in which the source varies", kLabels, kSpectrumInk,
                TextAnchor::left);
    return canvas.finish();
  }
  const PlotScale x(decade_ticks(kept.front().wave_number, kept.back().wave_number), true, kSpectrumLeft,
                    kSpectrumRight);
  const PlotScale y(share_ticks(kept, lost), true, kSpectrumBottom, kSpectrumTop);
  draw_legend(canvas);
  draw_axes(canvas, x, y);
  draw_curve(canvas, x, y, kept, kKept);
  draw_curve(canvas, x, y, lost, kLost);
  return canvas.finish();
}

}  // namespace weir
