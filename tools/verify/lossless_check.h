// What a sidecar says of the source, against the values that a lossless file decodes to: they are the source's.
#pragma once

#include <vector>

#include "format/sidecar/sidecar.h"
#include "tools/verify/tree_census.h"
#include "tools/verify/volume_check.h"

namespace weir {

/// `background`: the grid's. Range, zeros, voxels that are not finite, and the background's share where it was counted.
/// No check where the file is not lossless, where other values took the place of voxels without a valid one, or where
/// weir was older.
std::vector<VolumeCheck> check_lossless(const TreeCensus& census, float background, const Sidecar& sidecar);

}  // namespace weir
