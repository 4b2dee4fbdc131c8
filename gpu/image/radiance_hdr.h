// Radiance's picture format, .hdr: RGBE pixels, run-length encoded by scanline (Ward, Real Pixels, Graphics Gems II,
// 1991; Radiance's doc/filefmts.pdf). This reader exists because the packaged one, stb_image, never ends on a
// truncated file.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "gpu/image/image.h"

namespace weir {

bool is_radiance_hdr(std::span<const std::byte> bytes);

/// Returns the RGB of a file's bytes, rows from the top; EXPOSURE is not undone. Calls `check` as soon as the size is
/// known. Throws Error(input) "PATH: offset N: ..." if the bytes do not follow the format, or if the rows do not run
/// from the top left.
Image decode_radiance_hdr(std::span<const std::byte> bytes, const std::string& path, const ImageSizeCheck& check);

}  // namespace weir
