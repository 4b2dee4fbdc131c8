// The colour maps that a scene and --colormap may name; their colours are in gpu/image/colormap.h.
#pragma once

#include <string_view>

namespace weir {

/// In the order of the documentation.
inline constexpr std::string_view kColormapNames =
    "gray|white|heat|cool-warm|dusk|ct|water|magma|viridis|plasma|inferno|cividis";

}  // namespace weir
