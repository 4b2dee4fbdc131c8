// A sheet to draw a chart on, as a PNG picture or as SVG, by cairo. The code is in the driver weir_plot.so
// (ingest/drivers/driver.h).
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gpu/math/vector3.h"

namespace weir {

/// A point in pixels from the upper left corner; the first pixel's centre is (0.5, 0.5).
struct PlotPoint {
  double x = 0;
  double y = 0;
};

enum class PlotFormat { png, svg };
/// Returns the format of the file `path`, which the option `key` gives. Throws Error(usage) if the name ends in
/// neither .png nor .svg.
PlotFormat plot_format(const std::string& path, std::string_view key);

/// The point of a text that is placed: its left end, middle or right end, always at half its height.
enum class TextAnchor { left, middle, right };

/// Colours are sRGB, each channel from 0 to 1. Drawing outside the sheet is clipped.
class PlotCanvas {
 public:
  virtual ~PlotCanvas() = default;

  /// Fills [x0, x1) x [y0, y1).
  virtual void fill(double x0, double y0, double x1, double y1, const Float3& ink) = 0;
  /// Draws a line with round ends, `width` pixels wide.
  virtual void line(const PlotPoint& from, const PlotPoint& to, double width, const Float3& ink) = 0;
  /// Draws a closed polygon: filled, then outlined.
  virtual void polygon(std::span<const PlotPoint> corners, double width, const Float3& inside,
                       const Float3& outline) = 0;
  /// Draws UTF-8 text, other bytes as "?", in a sans-serif font of `size` pixels, upright or running upwards.
  virtual void text(const PlotPoint& at, std::string_view text, double size, const Float3& ink, TextAnchor anchor,
                    bool upwards = false) = 0;
  /// Returns the width in pixels that text() takes along x.
  virtual double text_width(std::string_view text, double size) = 0;
  /// Returns what a PNG's sheet shows so far: sRGB, three bytes a pixel, rows from the top. Throws Error(internal) for
  /// SVG.
  virtual std::vector<std::uint8_t> rgb24() = 0;
  /// Returns the file's bytes; nothing may be drawn after this. Throws Error(internal) if cairo fails.
  virtual std::string finish() = 0;
};

/// The function table of weir_plot.so, see make_plot_canvas.
struct PlotDriver {
  std::unique_ptr<PlotCanvas> (*make)(std::int32_t width, std::int32_t height, PlotFormat format, const Float3& paper);
};

/// Makes a sheet of the colour `paper`, sizes in pixels. Throws Error(input) if there is no weir_plot.so.
std::unique_ptr<PlotCanvas> make_plot_canvas(std::int32_t width, std::int32_t height, PlotFormat format,
                                             const Float3& paper);

}  // namespace weir
