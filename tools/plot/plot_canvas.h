// A small canvas for charts: filled boxes, smooth lines, and text in a fixed 5 x 7
// font.
#pragma once

#include <cstdint>
#include <string_view>

#include "gpu/image/image.h"

namespace weir {

/// Pixels of one character cell, spacing included.
inline constexpr std::int32_t kGlyphWidth = 6;
inline constexpr std::int32_t kGlyphHeight = 10;

/// In pixels; the first pixel's centre is (0.5, 0.5).
struct PlotPoint {
  float x = 0;
  float y = 0;
};

/// Pixel coordinates count from the upper left corner; what lies outside is clipped.
class PlotCanvas {
 public:
  PlotCanvas(std::int32_t width, std::int32_t height, const Float3& paper);

  /// Fills [x0, x1) x [y0, y1).
  void fill(std::int32_t x0, std::int32_t y0, std::int32_t x1, std::int32_t y1, const Float3& ink);
  /// A line of round ends, `width` pixels wide, blended at its edges; a disc where both ends are one point.
  void line(const PlotPoint& from, const PlotPoint& to, float width, const Float3& ink);
  /// Digits, letters and " .,:+-^()/_"; any other character leaves a gap. `scale` pixels are one of the font.
  void text(std::int32_t x, std::int32_t y, std::string_view text, const Float3& ink, std::int32_t scale = 1);
  /// Pixels along x that text() takes.
  static std::int32_t text_width(std::string_view text, std::int32_t scale = 1);

  const Image& image() const { return image_; }

 private:
  Image image_;
};

}  // namespace weir
