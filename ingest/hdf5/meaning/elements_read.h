// Which elements of an array a volume of it, or a region of that, has.
#pragma once

#include <optional>
#include <span>

#include "format/base/index.h"
#include "ingest/hdf5/meaning/axis_places.h"
#include "ingest/hdf5/meaning/volume_slice.h"
#include "ingest/hdf5/storage/unwritten_chunks.h"
#include "ingest/source/volume_region.h"

namespace weir {

/// Voxels of the slice's volume, in the order that it is stored in; of a region of it, which counts along axes as they
/// rise, those in that. Of a region that lies outside, which is refused later, all.
Box voxels_read(const VolumeSlice& slice, const std::optional<VolumeRegion>& region);

/// Of an array of `axes`: those of voxels_read(), with the components that are asked for.
ElementRange elements_read(std::span<const AxisPlace> axes, const VolumeSlice& slice,
                           const std::optional<VolumeRegion>& region);

}  // namespace weir
