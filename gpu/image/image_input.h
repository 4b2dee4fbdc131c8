// Reads pictures in linear light from disk. The first bytes tell the format.
#pragma once

#include <string>

#include "gpu/image/image.h"

namespace weir {

/// Returns the RGB of an OpenEXR file (half or float channels R, G and B, or one channel for gray; scanlines or
/// tiles) or a Radiance .hdr file, as stored, including NaN and infinities. Throws Error(input) if the file is
/// missing, of neither format, or broken.
Image read_image(const std::string& path, const ImageSizeCheck& check);

}  // namespace weir
