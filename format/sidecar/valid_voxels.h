// Tells which voxels a certificate covers, and describes the others.
#pragma once

#include <cstdint>
#include <string>

#include "format/sidecar/sidecar.h"

namespace weir {

/// Returns the number of voxels that the error covers: all except those that are not finite and those that hold no
/// data. Voxels without data count if they were kept as data.
std::uint64_t valid_voxels(const Sidecar& sidecar);

/// Returns whether every voxel reads as in the source, bit for bit: the file is lossless, and no voxel that is not
/// finite or holds no data was replaced.
bool lossless_everywhere(const Sidecar& sidecar);

/// Describes an error of the sidecar that is lossless, over all voxels or over what a scene shows: "lossless", or
/// "lossless over valid voxels" if other values replace the invalid voxels.
std::string lossless_text(const Sidecar& sidecar);

/// Returns "1234 of 8000 voxels (15.4 %) hold no data and read as the background". For one level of several: that they
/// are not of that level or, if values stand for "no data", are without data. For a file that is not lossless, in which
/// they may read as anything in inexact blocks: what is true there. Empty if all voxels hold data.
std::string missing_text(const Sidecar& sidecar);

/// Returns the same for voxels that are NaN or infinite, if the background replaces them; empty if they are kept.
std::string nonfinite_text(const Sidecar& sidecar);

/// Returns "76109 of 1727781 zeros (4.4 %) lost", for values that were 0 and decode to another value; empty if none is
/// lost.
std::string lost_zeros_text(std::uint64_t lost, std::uint64_t zeros);

}  // namespace weir
