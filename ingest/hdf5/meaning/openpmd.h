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

/// Fills label, spacing and origin of `axes` (the file's order) from axisLabels, gridSpacing, gridGlobalOffset
/// and gridUnitSI of the record, which is `object` or the group around it, and from position of `object`: the
/// place of the values in their cell. In metres. Attributes list the axes as axisLabels does: slowest first, or
/// fastest first where dataOrder is F. Leaves alone what is absent; what does not fit gets a note. The caller holds
/// Hdf5Lock.
void place_by_openpmd(hid_t object, std::span<const Hdf5Handle> groups, std::span<AxisPlace> axes);

/// Why the mesh of `object` has no axes of a volume: another geometry than a Cartesian one. Empty where it has, and
/// where it is no mesh. The caller holds Hdf5Lock.
std::string openpmd_obstacle(hid_t object, std::span<const Hdf5Handle> groups);

/// unitSI of `object`: values times it are in SI units.
std::optional<double> openpmd_unit_si(hid_t object);

/// The time of `object` in seconds: the attributes time and timeUnitSI of the iteration among `groups`, and timeOffset
/// of the record, which is in units of timeUnitSI, too ("Required for each Record").
std::optional<double> openpmd_time(hid_t object, std::span<const Hdf5Handle> groups);

/// Extents of a constant component (is_openpmd_constant), slowest first; empty where they are no extents.
std::vector<std::int64_t> openpmd_shape(hid_t object);

}  // namespace weir
