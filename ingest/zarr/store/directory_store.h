// A Zarr hierarchy as a directory with a file for each object.
#pragma once

#include <memory>
#include <string>

#include "ingest/zarr/store/zarr_store.h"

namespace weir {

/// Keys with "." or ".." in them are of no object: nothing outside `directory` is opened but by symbolic links in it.
std::unique_ptr<ZarrStore> make_directory_store(const std::string& directory);

}  // namespace weir
