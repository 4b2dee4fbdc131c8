// Checks without the source whether the figures of a sidecar agree with each other.
#pragma once

#include <vector>

#include "format/sidecar/sidecar.h"
#include "tools/verify/volume_check.h"

namespace weir {

/// Checks the root, share of the range, PSNR and largest value of each error; rms, largest value and voxel counts of
/// the gradient's error; extents, rate, counts of voxels and blocks, the histogram's ends, and the form of digests.
std::vector<VolumeCheck> check_certificate(const Sidecar& sidecar);

}  // namespace weir
