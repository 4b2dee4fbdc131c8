// What a dataset's attributes and coordinates say of a volume for its sidecar: long name, time, irregular axes.
#pragma once

#include <span>
#include <string>

#include "ingest/axes/axis_place.h"
#include "ingest/hdf5/file/hdf5_object.h"
#include "ingest/hdf5/meaning/volume_slice.h"
#include "ingest/source/field_details.h"

namespace weir {

/// Details of the volume `slice` of `object`, an array of `axes` (slowest first) in `file`. The time is the coordinate
/// of a leading axis; else what CF's attribute `coordinates` names, of units "... since ..."; else a VTKHDF file's;
/// else that of openPMD's iteration, in seconds. The caller holds Hdf5Lock.
FieldDetails field_details(hid_t file, const Hdf5Object& object, std::span<const AxisPlace> axes,
                           const VolumeSlice& slice);

/// Attribute long_name, else WRF's description; empty where there is neither. The caller holds Hdf5Lock.
std::string long_name_of(hid_t object);

}  // namespace weir
