// Reads PNG pictures from disk, as a display shows them.
#pragma once

#include <string>

#include "gpu/image/image.h"

namespace weir {

/// Returns the picture in linear light, [0, 1]. Gray and palettes become RGB. Applies the gamma that the file states,
/// otherwise sRGB. Throws Error(input) if the file is missing, no PNG or broken, or if it has 16 bits per channel or
/// transparent pixels.
Image read_png(const std::string& path);

}  // namespace weir
