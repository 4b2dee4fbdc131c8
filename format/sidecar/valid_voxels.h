// Which voxels a certificate is of, and what is said of the others.
#pragma once

#include <cstdint>
#include <string>

#include "format/sidecar/sidecar.h"

namespace weir {

/// Voxels that the error is of: all but those that are not finite and, unless they were kept as data, those that hold
/// none.
std::uint64_t valid_voxels(const Sidecar& sidecar);

/// Whether every voxel reads as the source's, bit for bit: the file is lossless, and nothing took the place of a voxel
/// that is not finite or holds no data.
bool lossless_everywhere(const Sidecar& sidecar);

/// Of an error of the sidecar, of all or of what a scene shows, that is lossless: "lossless", or "lossless over valid
/// voxels" where other values take the place of voxels that are not.
std::string lossless_text(const Sidecar& sidecar);

/// "1234 of 8000 voxels (15.4 %) hold no data and read as the background"; of one level of several that they are not of
/// it, or, where values stand for "no data", are without data; of a file that is not lossless, in whose inexact blocks
/// they may read as anything, what is true of them there. Empty where none does.
std::string missing_text(const Sidecar& sidecar);

/// The same of voxels that are NaN or infinite, where the background takes their place; empty where they are kept.
std::string nonfinite_text(const Sidecar& sidecar);

/// "76109 of 1727781 zeros (4.4 %) lost": values that were 0 and are no longer; empty where none is lost.
std::string lost_zeros_text(std::uint64_t lost, std::uint64_t zeros);

}  // namespace weir
