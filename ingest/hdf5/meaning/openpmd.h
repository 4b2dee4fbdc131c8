// Meshes by the openPMD standard (version 1 and 2, "mesh based records").
#pragma once

#include <hdf5.h>

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "ingest/axes/axis_place.h"
#include "ingest/hdf5/file/hdf5_handle.h"

namespace weir {

/// Fills label, spacing and origin of `axes` (the file's order), in metres. Reads axisLabels, gridSpacing,
/// gridGlobalOffset and gridUnitSI of the record, which is `object` or the group around it. Reads `position` of
/// `object`: the place of the values in their cell. Attributes list the axes in the order of axisLabels: slowest
/// first, or fastest first if dataOrder is F. Leaves absent attributes alone; attributes that do not fit get a note.
/// The caller holds Hdf5Lock.
void place_by_openpmd(hid_t object, std::span<const Hdf5Handle> groups, std::span<AxisPlace> axes);

/// Returns why the mesh of `object` has no axes of a volume: its geometry is not Cartesian. Empty if it has such
/// axes, or if `object` is no mesh. The caller holds Hdf5Lock.
std::string openpmd_obstacle(hid_t object, std::span<const Hdf5Handle> groups);

/// Returns unitSI of `object`: the factor that turns its values into SI units.
std::optional<double> openpmd_unit_si(hid_t object);

/// Returns the time of `object` in seconds: the iteration's attributes time and timeUnitSI (from `groups`) and the
/// record's timeOffset, which is in units of timeUnitSI, too ("Required for each Record").
std::optional<double> openpmd_time(hid_t object, std::span<const Hdf5Handle> groups);

/// Returns the extents of a constant component (is_openpmd_constant), slowest first; empty if `shape` holds no
/// extents.
std::vector<std::int64_t> openpmd_shape(hid_t object);

}  // namespace weir
