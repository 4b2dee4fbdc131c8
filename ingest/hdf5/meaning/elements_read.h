// Which elements of an array a volume of it, or a region of that, has.
#pragma once

#include <optional>
#include <span>

#include "ingest/hdf5/meaning/axis_places.h"
#include "ingest/hdf5/meaning/volume_slice.h"
#include "ingest/hdf5/storage/unwritten_chunks.h"
#include "ingest/source/volume_region.h"

namespace weir {

/// Of an array of `axes`: those of the slice, with the components that are asked for; of a region of it, which counts
/// along axes as they rise, those in that. Of a region that lies outside, which is refused later, all of the slice.
ElementRange elements_read(std::span<const AxisPlace> axes, const VolumeSlice& slice,
                           const std::optional<VolumeRegion>& region);

}  // namespace weir
