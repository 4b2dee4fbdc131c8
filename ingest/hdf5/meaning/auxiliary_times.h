// Times by CF's auxiliary coordinates: variables that an array names, and that are no coordinates of an axis.
#pragma once

#include <span>
#include <vector>

#include "ingest/axes/axis_place.h"
#include "ingest/axes/volume_time.h"
#include "ingest/hdf5/file/hdf5_handle.h"
#include "ingest/hdf5/file/hdf5_object.h"

namespace weir {

/// Those that the attribute `coordinates` of `object` names, in its group or one around it, `groups` from the inside
/// out (CF 5). Throws Error(input) where one cannot be read. The caller holds Hdf5Lock, here and below.
std::vector<TimeValues> auxiliary_times(const Hdf5Object& object, std::span<const Hdf5Handle> groups);

/// Sets `unwritten` of an axis of time that may grow and has no coordinates, where such times along the same dimension
/// are more than it has elements: NetCDF-4 writes the length of such a dimension nowhere else.
void count_unwritten_times(const Hdf5Object& object, std::span<const Hdf5Handle> groups, std::span<AxisPlace> axes);

}  // namespace weir
