// JPEG pictures in memory, by libjpeg-turbo; a build without it (WEIR_JPEG=OFF) has none.
#pragma once

#include <cstddef>
#include <vector>

#include "gpu/image/image.h"
#include "gpu/image/image_output.h"

namespace weir {

/// Whether this build can write JPEG.
bool has_jpeg();

/// Baseline JPEG in sRGB, colours at full resolution: pictures are small ones that are shown large. `quality` from 1 to
/// 100. Throws Error(internal) where the library fails, or this build has none.
std::vector<std::byte> encode_jpeg(const Image& image, const ToneMapping& tone, int quality);

}  // namespace weir
