// Arrays of Zarr version 2: .zarray and .zattrs.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "ingest/zarr/metadata/zarr_array.h"

namespace weir {

/// The array that `metadata`, the object in its .zarray, describes (Zarr storage specification, version 2), with
/// `attributes`, the object in its .zattrs. Throws Error(input), beginning with `where`, the path of .zarray, where it
/// is damaged or has what is not read here: other types than numbers, filters but delta and shuffle, other compressors.
ZarrArray parse_zarr_v2(const nlohmann::json& metadata, nlohmann::json attributes, const std::string& where);

}  // namespace weir
