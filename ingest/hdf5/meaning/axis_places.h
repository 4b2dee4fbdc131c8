// What the axes of an array are called and where its elements lie along them,
// from whatever convention the file follows.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ingest/axes/axis_place.h"
#include "ingest/hdf5/file/hdf5_object.h"

namespace weir {

/// The axes of `object`, an array of `extents`, in the file's order, slowest first: by openPMD, then by
/// NetCDF's coordinate variables, then by plain attributes, which count from the last axis that holds no components;
/// what one leaves open the next may say. The caller holds Hdf5Lock.
std::vector<AxisPlace> axis_places(hid_t file, const Hdf5Object& object, std::span<const std::int64_t> extents);

}  // namespace weir
