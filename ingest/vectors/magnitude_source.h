// The length of vectors whose components are volumes of their own: "u", "v" and "w" of one file.
#pragma once

#include <memory>
#include <vector>

#include "ingest/source/volume_source.h"

namespace weir {

/// sqrt(sum of squares) in double of the float32 values of `components`, two or more, which lie on the same voxels. A
/// voxel that is missing in one is missing; NaN where one is NaN. Reading takes pieces of one chunk, or of 65,536
/// voxels, at a time on each thread. Throws Error(input), naming the two, where their voxels are not the same.
std::unique_ptr<VolumeSource> magnitude_of(std::vector<std::unique_ptr<VolumeSource>> components);

}  // namespace weir
