// A Zarr hierarchy in a zip file, which is read in place.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "ingest/zarr/store/zarr_store.h"

namespace weir {

/// Returns a store of the entries of the zip file `path`. Stored entries can be read in parts, deflated entries only
/// as a whole. A read of a whole entry is checked against its CRC-32. The zip file's directory may take a sixteenth
/// of `memory` bytes. Throws the errors of read_zip_directory.
std::unique_ptr<ZarrStore> make_zip_store(const std::string& path, std::uint64_t memory);

}  // namespace weir
