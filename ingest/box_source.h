// A region of interest of another source.
#pragma once

#include <memory>

#include "ingest/volume_source.h"

namespace weir {

/// The voxels of `region` (index space, half open) of `source`, as a volume of its own. Indices stay
/// global: index_origin becomes region.lo, so every voxel keeps its index and world position.
/// Throws Error(usage), naming region and domain, where region is empty or reaches outside.
std::unique_ptr<VolumeSource> crop_source(std::unique_ptr<VolumeSource> source, const Box& region);

}  // namespace weir
