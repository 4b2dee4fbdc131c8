// Radiance's picture format, .hdr: RGBE pixels, run-length encoded by scanline
// (Ward, Real Pixels, Graphics Gems II, 1991; Radiance's doc/filefmts.pdf). Own
// code, since the reader that is packaged, stb_image, never ends on a file cut short.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "gpu/image/image.h"

namespace weir {

bool is_radiance_hdr(std::span<const std::byte> bytes);

/// RGB of a file's bytes, rows from the top; EXPOSURE is not undone. `check` is called once the size is
/// known. Throws Error(input) "PATH: offset N: ..." where the bytes are not as the format has them, or
/// the rows do not run from the top left.
Image decode_radiance_hdr(std::span<const std::byte> bytes, const std::string& path, const ImageSizeCheck& check);

}  // namespace weir
