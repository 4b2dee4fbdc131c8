// Arrays of Zarr version 2: .zarray and .zattrs.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "ingest/zarr/metadata/zarr_array.h"

namespace weir {

/// Returns the array that `metadata`, the object in its .zarray, describes (Zarr storage specification, version 2),
/// with `attributes`, the object in its .zattrs. Throws Error(input), beginning with `where`, the path of .zarray, if
/// the metadata are damaged or use a feature that is not supported: types other than numbers and bool, filters other
/// than delta and shuffle, or other compressors.
ZarrArray parse_zarr_v2(const nlohmann::json& metadata, nlohmann::json attributes, const std::string& where);

}  // namespace weir
