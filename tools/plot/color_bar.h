// Draws a colour bar beside a picture; the bar shows the colour of each value.
#pragma once

#include <cstdint>
#include <string>

#include "gpu/render/backend.h"
#include "gpu/scene/transfer_function.h"

namespace weir {

/// Draws the colours of `transfer` from its lowest value at the bottom to its highest, with ticks at round numbers and
/// `title` running upwards beside them, dark on white. The bar is `height` pixels high and as wide as the numbers
/// need, a multiple of 8. Colours are the map's, without light and exposure, in linear light. Throws as
/// make_plot_canvas, and Error(usage) if `height` is below kLeastColorBar.
Image draw_color_bar(const TransferFunction& transfer, const std::string& title, std::int32_t height);

/// The least height in pixels; numbers on a lower bar could not be read.
inline constexpr std::int32_t kLeastColorBar = 64;

/// Returns `picture` as a screen shows it, with `bar`, which has the same height, at its right.
Picture with_color_bar(const Picture& picture, const Image& bar);

}  // namespace weir
