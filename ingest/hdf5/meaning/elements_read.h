// Computes which elements of an array are read for a volume or for a region of it.
#pragma once

#include <optional>
#include <span>

#include "format/base/index.h"
#include "ingest/hdf5/meaning/axis_places.h"
#include "ingest/hdf5/meaning/volume_slice.h"
#include "ingest/hdf5/storage/unwritten_chunks.h"
#include "ingest/source/volume_region.h"

namespace weir {

/// Returns the voxels of the slice's volume in stored order. With a region, which counts along rising axes, returns
/// the voxels in the region. For a region outside the volume, which is refused later, returns all voxels.
Box voxels_read(const VolumeSlice& slice, const std::optional<VolumeRegion>& region);

/// Returns the elements of an array of `axes` that hold the voxels of voxels_read(), with the requested components.
ElementRange elements_read(std::span<const AxisPlace> axes, const VolumeSlice& slice,
                           const std::optional<VolumeRegion>& region);

}  // namespace weir
