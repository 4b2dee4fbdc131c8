// Reads details of a volume for its sidecar from attributes and coordinates: long name, time, irregular axes.
#pragma once

#include <span>
#include <string>

#include "ingest/axes/axis_place.h"
#include "ingest/hdf5/file/hdf5_object.h"
#include "ingest/hdf5/meaning/volume_slice.h"
#include "ingest/source/field_details.h"

namespace weir {

/// Returns the details of the volume `slice` of `object`, an array of `axes` (slowest first) in `file`. The time
/// comes from the first of these that exists: the coordinate of a leading axis, CF's attribute `coordinates` with
/// units "... since ...", a VTKHDF file's time, or the time of openPMD's iteration in seconds. The caller holds
/// Hdf5Lock.
FieldDetails field_details(hid_t file, const Hdf5Object& object, std::span<const AxisPlace> axes,
                           const VolumeSlice& slice);

/// Returns the attribute long_name, otherwise WRF's description; empty if there is neither. The caller holds
/// Hdf5Lock.
std::string long_name_of(hid_t object);

}  // namespace weir
