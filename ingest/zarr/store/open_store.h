// The store of a Zarr hierarchy by its path.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "ingest/zarr/store/zarr_store.h"

namespace weir {

/// The store at `path`: a directory, a file in it that says what it is (kDirectoryHeads), or a zip file, whose
/// directory takes at most a sixteenth of `memory` bytes. Throws Error(input) where it cannot be read.
std::unique_ptr<ZarrStore> open_zarr_store(const std::string& path, std::uint64_t memory);

}  // namespace weir
