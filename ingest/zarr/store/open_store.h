// Opens the store of a Zarr hierarchy by its path.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "ingest/zarr/store/zarr_store.h"

namespace weir {

/// Returns the store at `path`: a directory, one of its metadata files (kDirectoryHeads), or a zip file. The
/// directory of a zip file may take at most a sixteenth of `memory` bytes. Throws Error(input) if the store cannot be
/// read.
std::unique_ptr<ZarrStore> open_zarr_store(const std::string& path, std::uint64_t memory);

}  // namespace weir
