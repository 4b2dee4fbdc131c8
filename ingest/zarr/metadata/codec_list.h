// The codecs of an array of Zarr version 3.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "ingest/zarr/metadata/zarr_array.h"

namespace weir {

/// Of an extension point, {"name": "gzip", "configuration": {...}} or "gzip" alone; empty where it has none.
std::string extension_name(const nlohmann::json& extension);

/// Levels of shards that are read.
inline constexpr std::size_t kMostShardLevels = 4;

/// Fills array.codecs and array.shards from the list `codecs`; array.type and array.chunk are known. Throws
/// Error(input), beginning with `where`, for a codec that is not read here, one out of place or with a configuration
/// that does not fit; other codecs beside sharding_indexed, and more than kMostShardLevels in each other, are not read.
void read_codecs(const nlohmann::json& codecs, ZarrArray& array, const std::string& where);

}  // namespace weir
