// A small canvas for charts: filled boxes and text in a fixed 5 x 7 font.
#pragma once

#include <cstdint>
#include <string_view>

#include "gpu/image.h"

namespace weir {

/// Pixels of one character cell, spacing included.
inline constexpr std::int32_t kGlyphWidth = 6;
inline constexpr std::int32_t kGlyphHeight = 8;

/// Pixel coordinates count from the upper left corner; what lies outside is clipped.
class PlotCanvas {
 public:
  PlotCanvas(std::int32_t width, std::int32_t height, const Float3& paper);

  /// Fills [x0, x1) x [y0, y1).
  void fill(std::int32_t x0, std::int32_t y0, std::int32_t x1, std::int32_t y1, const Float3& ink);
  /// Digits, lower-case letters and " .,+-^()/"; any other character leaves a gap.
  void text(std::int32_t x, std::int32_t y, std::string_view text, const Float3& ink);
  /// Pixels along x that text() takes.
  static std::int32_t text_width(std::string_view text);

  const Image& image() const { return image_; }

 private:
  Image image_;
};

}  // namespace weir
