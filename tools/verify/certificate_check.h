// Whether the figures of a sidecar agree with each other: what can be told without the source.
#pragma once

#include <vector>

#include "format/sidecar/sidecar.h"
#include "tools/verify/volume_check.h"

namespace weir {

/// Root, PSNR and largest value of each error, extents, rate, and counts of voxels and blocks.
std::vector<VolumeCheck> check_certificate(const Sidecar& sidecar);

}  // namespace weir
