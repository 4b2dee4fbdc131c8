// A sheet to draw a chart on, as a PNG picture or as SVG, by cairo: the driver weir_plot.so (ingest/drivers/driver.h).
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gpu/math/vector3.h"

namespace weir {

/// In pixels from the upper left corner; the first pixel's centre is (0.5, 0.5).
struct PlotPoint {
  double x = 0;
  double y = 0;
};

enum class PlotFormat { png, svg };
/// Of the file that the option `key` gives. Throws Error(usage) where its name ends in neither .png nor .svg.
PlotFormat plot_format(const std::string& path, std::string_view key);

/// Which point of a text, at the middle of its height, it is placed by.
enum class TextAnchor { left, middle, right };

/// Colours are sRGB, each channel from 0 to 1; what lies outside of the sheet is clipped.
class PlotCanvas {
 public:
  virtual ~PlotCanvas() = default;

  /// Fills [x0, x1) x [y0, y1).
  virtual void fill(double x0, double y0, double x1, double y1, const Float3& ink) = 0;
  /// A line of round ends, `width` pixels wide.
  virtual void line(const PlotPoint& from, const PlotPoint& to, double width, const Float3& ink) = 0;
  /// A closed polygon: filled, then outlined.
  virtual void polygon(std::span<const PlotPoint> corners, double width, const Float3& inside,
                       const Float3& outline) = 0;
  /// UTF-8, other bytes as "?", in a sans-serif font of `size` pixels, upright or from the bottom up.
  virtual void text(const PlotPoint& at, std::string_view text, double size, const Float3& ink, TextAnchor anchor,
                    bool upwards = false) = 0;
  /// Pixels along x that text() takes.
  virtual double text_width(std::string_view text, double size) = 0;
  /// Of a PNG's sheet what is drawn so far: sRGB, three bytes a pixel, rows from the top. Throws Error(internal) for
  /// SVG.
  virtual std::vector<std::uint8_t> rgb24() = 0;
  /// The file's bytes; nothing is drawn after it. Throws Error(internal) where cairo fails.
  virtual std::string finish() = 0;
};

/// What weir_plot.so does: make_plot_canvas.
struct PlotDriver {
  std::unique_ptr<PlotCanvas> (*make)(std::int32_t width, std::int32_t height, PlotFormat format, const Float3& paper);
};

/// A sheet of `paper`, pixels. Throws Error(input) where there is no weir_plot.so.
std::unique_ptr<PlotCanvas> make_plot_canvas(std::int32_t width, std::int32_t height, PlotFormat format,
                                             const Float3& paper);

}  // namespace weir
