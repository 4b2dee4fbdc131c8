// The numbers of a small Zarr array of one axis or none: coordinates, a time.
#pragma once

#include <string>
#include <vector>

#include "ingest/source/stored_value.h"
#include "ingest/zarr/metadata/zarr_array.h"
#include "ingest/zarr/store/zarr_store.h"

namespace weir {

/// All numbers of the array at `key`, after `mapping`, NaN where one is missing or its chunk is not stored and has no
/// fill value. `array` has at most one axis, and chunks that memory has room for. Throws what ZarrChunks throws.
std::vector<double> zarr_numbers(ZarrStore& store, const std::string& key, ZarrArray array,
                                 const ValueMapping& mapping);

}  // namespace weir
