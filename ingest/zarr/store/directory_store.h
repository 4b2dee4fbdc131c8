// A Zarr hierarchy that is a directory with one file for each object.
#pragma once

#include <memory>
#include <string>

#include "ingest/zarr/store/zarr_store.h"

namespace weir {

/// Returns a store of the files in `directory`. A key with "." or ".." in it finds no object, so that only symbolic
/// links can lead out of `directory`.
std::unique_ptr<ZarrStore> make_directory_store(const std::string& directory);

}  // namespace weir
