// Pictures in linear light from disk, told apart by their first bytes.
#pragma once

#include <string>

#include "gpu/image/image.h"

namespace weir {

/// RGB of an OpenEXR file (half or float channels R, G and B, or one channel for gray; scanlines or tiles)
/// or a Radiance .hdr file, as stored, NaN and infinities included. Throws Error(input) where the file is
/// missing, neither of the two, or broken.
Image read_image(const std::string& path, const ImageSizeCheck& check);

}  // namespace weir
