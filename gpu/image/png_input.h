// PNG pictures from disk, as a display shows them.
#pragma once

#include <string>

#include "gpu/image/image.h"

namespace weir {

/// The picture in linear light, [0, 1]: gray and palettes become RGB; a gamma that the file states counts, else it is
/// sRGB. Throws Error(input) where the file is missing, no PNG or broken, or where no one picture of 8 bits a channel
/// is in it: 16 bits, or transparent pixels.
Image read_png(const std::string& path);

}  // namespace weir
