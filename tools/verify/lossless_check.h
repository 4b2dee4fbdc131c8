// Checks what a sidecar says of the source against the decoded values of a lossless file, which are the source's
// values.
#pragma once

#include <vector>

#include "format/sidecar/sidecar.h"
#include "tools/verify/tree_census.h"
#include "tools/verify/volume_check.h"

namespace weir {

/// Checks range, zeros, non-finite voxels, and the background's share if it was counted. `background` is the grid's.
/// Returns no checks if the file is not lossless, if voxels without a valid value got other values, or if an older
/// weir wrote the sidecar.
std::vector<VolumeCheck> check_lossless(const TreeCensus& census, float background, const Sidecar& sidecar);

}  // namespace weir
