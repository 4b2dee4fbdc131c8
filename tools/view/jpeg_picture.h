// Encodes JPEG pictures in memory with libjpeg-turbo. A build with WEIR_JPEG=OFF cannot.
#pragma once

#include <cstddef>
#include <vector>

#include "gpu/image/image.h"
#include "gpu/image/image_output.h"

namespace weir {

/// Returns whether this build can write JPEG.
bool has_jpeg();

/// Returns a baseline JPEG in sRGB, with colours at full resolution because small pictures are shown enlarged.
/// `quality` from 1 to 100. Throws Error(internal) if the library fails or this build has no JPEG.
std::vector<std::byte> encode_jpeg(const Image& image, const ToneMapping& tone, int quality);

}  // namespace weir
