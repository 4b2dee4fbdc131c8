// Arrays of Zarr version 3: zarr.json.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "ingest/zarr/metadata/zarr_array.h"

namespace weir {

/// Returns the array that `metadata`, the object in its zarr.json, describes (Zarr core specification, version 3,
/// with the codecs bytes, transpose, gzip, zlib, zstd, blosc, crc32c and sharding_indexed). Throws Error(input),
/// beginning with `where`, the path of zarr.json, if the metadata are damaged or use a feature that is not supported:
/// types other than numbers and bool, other chunk grids, storage transformers, other codecs, or extensions that must
/// be understood.
ZarrArray parse_zarr_v3(const nlohmann::json& metadata, const std::string& where);

}  // namespace weir
