// What a dataset's attributes and coordinates say of a volume for its sidecar: long name, time, irregular axes.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "ingest/hdf5/file/hdf5_object.h"
#include "ingest/hdf5/meaning/axis_place.h"
#include "ingest/hdf5/meaning/volume_slice.h"
#include "ingest/source/field_details.h"

namespace weir {

/// Details of the volume `slice` of `object`, an array of `axes` (slowest first) in `file`. The time is the coordinate
/// of a leading axis; else what CF's attribute `coordinates` names, of units "... since ..."; else that of openPMD's
/// iteration, in seconds. The caller holds Hdf5Lock.
FieldDetails field_details(hid_t file, const Hdf5Object& object, std::span<const AxisPlace> axes,
                           const VolumeSlice& slice);

/// "axis x (xh) is in km, y (yh) in km, z (zh) in m", where a volume's axes x, y, z that have a spacing have it in
/// different units; else empty.
std::string units_note(std::span<const AxisPlace* const, 3> axes);

/// "its axes are called x, y, z, slowest first: the file's z lies along x, ...", where the names of at least two of a
/// volume's axes x, y, z are those of others among them; else empty.
std::string order_note(std::span<const AxisPlace* const, 3> axes);

/// What is said of `axis`, a volume's x, y or z by `of_volume` (0, 1, 2), of which spacing and origin are not all: that
/// its coordinates are irregular, or that they fall. Empty where that is nothing.
std::string axis_note(const AxisPlace& axis, std::size_t of_volume);

/// Attribute long_name, else WRF's description; empty where there is neither. The caller holds Hdf5Lock.
std::string long_name_of(hid_t object);

}  // namespace weir
