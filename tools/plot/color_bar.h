// A colour bar beside a picture: which value has which colour.
#pragma once

#include <cstdint>
#include <string>

#include "gpu/render/backend.h"
#include "gpu/scene/transfer_function.h"

namespace weir {

/// The colours of `transfer` from its lowest value, at the bottom, to its highest, with ticks at round numbers and
/// `title` upwards along them, dark on white. `height` pixels, and as wide as the numbers need, a multiple of 8. The
/// colours are the map's, without light and exposure. In linear light. Throws as make_plot_canvas, Error(usage) where
/// `height` is below kLeastColorBar.
Image draw_color_bar(const TransferFunction& transfer, const std::string& title, std::int32_t height);

/// Pixels below which no number can be read.
inline constexpr std::int32_t kLeastColorBar = 64;

/// `picture` as a screen shows it, `bar`, of the same height, at its right.
Picture with_color_bar(const Picture& picture, const Image& bar);

}  // namespace weir
