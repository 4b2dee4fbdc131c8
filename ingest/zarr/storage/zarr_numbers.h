// Reads the numbers of a small Zarr array with one axis or none, for example coordinates or a time.
#pragma once

#include <string>
#include <vector>

#include "ingest/source/stored_value.h"
#include "ingest/zarr/metadata/zarr_array.h"
#include "ingest/zarr/store/zarr_store.h"

namespace weir {

/// Returns all numbers of the array at `key`, after `mapping`. A number is NaN if it is missing, or if its chunk is
/// not stored and there is no fill value. `array` has at most one axis, and chunks that fit in memory. Throws the
/// errors of ZarrChunks.
std::vector<double> zarr_numbers(ZarrStore& store, const std::string& key, ZarrArray array,
                                 const ValueMapping& mapping);

}  // namespace weir
