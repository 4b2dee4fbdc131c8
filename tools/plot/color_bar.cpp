#include "tools/plot/color_bar.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "format/base/error.h"
#include "format/base/text.h"
#include "gpu/image/colormap.h"
#include "tools/plot/plot_axis.h"
#include "tools/plot/plot_canvas.h"

namespace weir {
namespace {

constexpr Float3 kBarPaper{1, 1, 1};
constexpr Float3 kBarInk{0.15F, 0.15F, 0.15F};
constexpr std::int32_t kColorBarWidthUnit = 8;  // pixels: video encoders do not take odd widths
// Lengths in units of the text size.
constexpr double kColorBarGap = 0.5;
constexpr double kColorBarWidth = 1.5;
constexpr double kColorBarTickSpace = 3;  // least space between two ticks

struct ColorBarTick {
  double value;
  std::string label;
};

// Returns ticks at round numbers inside the range, about as many as there is room for. If fewer than two fit, returns
// the range's ends, exact to a hundredth of the range; for a single value, that value.
std::vector<ColorBarTick> color_bar_ticks(double low, double high, int most) {
  if (!(high > low)) return {{low, short_number(low)}};
  const double step = tick_step(high - low, most);
  const double slack = 1e-6 * step;  // the rounding of float32 ends that should be round numbers
  std::vector<ColorBarTick> ticks;
  for (double i = std::ceil((low - slack) / step); i * step <= high + slack; ++i) {
    ticks.push_back({i * step, tick_text(i * step, step)});
  }
  if (ticks.size() >= 2) return ticks;
  const double hundredth = (high - low) / 100;
  return {{low, tick_text(low, hundredth)}, {high, tick_text(high, hundredth)}};
}

Float3 display_color(const Rgba& color) {
  return {srgb_from_linear(color.r), srgb_from_linear(color.g), srgb_from_linear(color.b)};
}

}  // namespace

Image draw_color_bar(const TransferFunction& transfer, const std::string& title, std::int32_t height) {
  if (height < kLeastColorBar) {
    throw Error(ErrorKind::usage, compose(option("colorbar"), " needs a picture of at least ", cat(kLeastColorBar),
                                          " pixels in height, this one has ", cat(height)));
  }
  const double size = std::clamp(height / 36.0, 9.0, 48.0);
  const double top = size;
  const double bottom = height - size;
  const auto most = static_cast<int>((bottom - top) / (kColorBarTickSpace * size));
  const std::vector<ColorBarTick> ticks = color_bar_ticks(transfer.low(), transfer.high(), std::max(most, 1));

  const auto measure = make_plot_canvas(1, 1, PlotFormat::png, kBarPaper);
  double labels = 0;
  for (const ColorBarTick& tick : ticks) labels = std::max(labels, measure->text_width(tick.label, size));
  const double long_title = measure->text_width(title, size);
  const double title_size = long_title > height - size ? size * (height - size) / long_title : size;
  const double left = std::round(size);
  const double right = std::round(left + kColorBarWidth * size);
  const double numbers = right + 2 * kColorBarGap * size;
  const double title_at = numbers + labels + (kColorBarGap + 0.5) * size;
  const double end = title.empty() ? numbers + labels + size : title_at + size;
  const std::int32_t width = static_cast<std::int32_t>(std::ceil(end / kColorBarWidthUnit)) * kColorBarWidthUnit;

  const auto canvas = make_plot_canvas(width, height, PlotFormat::png, kBarPaper);
  const double reach = static_cast<double>(transfer.high()) - transfer.low();
  const auto rows = static_cast<int>(std::lround(bottom - top));
  const double first = std::round(top);
  for (int row = 0; row < rows; ++row) {
    const double part = 1 - (row + 0.5) / rows;
    const auto value = static_cast<float>(transfer.low() + part * reach);
    canvas->fill(left, first + row, right, first + row + 1, display_color(transfer.at(value)));
  }
  for (const ColorBarTick& tick : ticks) {
    const double part = reach > 0 ? std::clamp((tick.value - transfer.low()) / reach, 0.0, 1.0) : 0.5;
    const double y = first + (1 - part) * rows;
    canvas->fill(right, std::round(y) - 1, std::round(right + kColorBarGap * size), std::round(y), kBarInk);
    canvas->text({numbers, y}, tick.label, size, kBarInk, TextAnchor::left);
  }
  canvas->text({title_at, height / 2.0}, title, title_size, kBarInk, TextAnchor::middle, true);

  Image image(width, height);
  const std::vector<std::uint8_t> bytes = canvas->rgb24();
  const auto channel = [&](std::size_t i) { return linear_from_srgb(static_cast<float>(bytes[i]) / 255); };
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    image.pixels[i] = {channel(3 * i), channel(3 * i + 1), channel(3 * i + 2)};
  }
  return image;
}

Picture with_color_bar(const Picture& picture, const Image& bar) {
  Picture both{.image = Image(picture.image.width + bar.width, picture.image.height),
               .tone = {1, false},  // no further tone mapping: the pixels already have it
               .render_s = picture.render_s,
               .cache = picture.cache,
               .missed = picture.missed,
               .finest_level = picture.finest_level,
               .levels_note = picture.levels_note,
               .memory_note = picture.memory_note};
  const auto shown = [&](float radiance) { return tone_map(radiance, picture.tone); };
  for (std::int32_t y = 0; y < both.image.height; ++y) {
    for (std::int32_t x = 0; x < picture.image.width; ++x) {
      const Float3& pixel = picture.image.at(x, y);
      both.image.pixels[both.image.index(x, y)] = {shown(pixel.x), shown(pixel.y), shown(pixel.z)};
    }
    for (std::int32_t x = 0; x < bar.width; ++x) {
      both.image.pixels[both.image.index(picture.image.width + x, y)] = bar.at(x, y);
    }
  }
  return both;
}

}  // namespace weir
