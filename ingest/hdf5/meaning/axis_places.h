// The names of an array's axes and the positions of its elements along them, from any convention that the file
// follows.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ingest/axes/axis_place.h"
#include "ingest/hdf5/file/hdf5_object.h"

namespace weir {

/// Returns the axes of `object`, an array of `extents`, in the file's order, slowest first. Three sources are tried
/// in turn: openPMD, NetCDF's coordinate variables, and plain attributes, which count from the last axis without
/// components. A later source fills in what an earlier source leaves open. The caller holds Hdf5Lock.
std::vector<AxisPlace> axis_places(hid_t file, const Hdf5Object& object, std::span<const std::int64_t> extents);

}  // namespace weir
