// The codecs of an array of Zarr version 3.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "ingest/zarr/metadata/zarr_array.h"

namespace weir {

/// Returns the name of an extension point, {"name": "gzip", "configuration": {...}} or "gzip" alone; empty if it has
/// none.
std::string extension_name(const nlohmann::json& extension);

/// The most levels of shards inside shards that are read.
inline constexpr std::size_t kMostShardLevels = 4;

/// Sets array.codecs and array.shards from the list `codecs`; array.type and array.chunk must be set already. Throws
/// Error(input), beginning with `where`, for a codec that is not supported, is out of place or has an invalid
/// configuration. Other codecs beside sharding_indexed, and more than kMostShardLevels levels of shards, are not
/// supported.
void read_codecs(const nlohmann::json& codecs, ZarrArray& array, const std::string& where);

}  // namespace weir
