// Reads times from CF's auxiliary coordinates: variables that an array names and that are not coordinates of an axis.
#pragma once

#include <span>
#include <vector>

#include "ingest/axes/axis_place.h"
#include "ingest/axes/volume_time.h"
#include "ingest/hdf5/file/hdf5_handle.h"
#include "ingest/hdf5/file/hdf5_object.h"

namespace weir {

/// Returns the times that the attribute `coordinates` of `object` names (CF 5). They lie in the object's group or in
/// a group around it; `groups` lists these innermost first. Throws Error(input) if a time cannot be read. For both
/// functions the caller holds Hdf5Lock.
std::vector<TimeValues> auxiliary_times(const Hdf5Object& object, std::span<const Hdf5Handle> groups);

/// Sets `unwritten` of a time axis that may grow and has no coordinates, if auxiliary times along the same dimension
/// have more elements than the axis. NetCDF-4 writes the length of such a dimension nowhere else.
void count_unwritten_times(const Hdf5Object& object, std::span<const Hdf5Handle> groups, std::span<AxisPlace> axes);

}  // namespace weir
