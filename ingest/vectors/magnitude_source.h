// The length of vectors that have each component in a volume of its own: "u", "v" and "w" of one file.
#pragma once

#include <memory>
#include <vector>

#include "ingest/source/volume_source.h"

namespace weir {

/// Returns a source of sqrt(sum of squares), computed in double from the float32 values of `components`: two or more
/// volumes on the same voxels. A voxel is missing if it is missing in one component, and NaN if one component is NaN.
/// Each thread reads pieces of one chunk, or of 65,536 voxels, at a time. Throws Error(input), naming two components,
/// if their voxels are not the same.
std::unique_ptr<VolumeSource> magnitude_of(std::vector<std::unique_ptr<VolumeSource>> components);

}  // namespace weir
