// A Zarr hierarchy in a zip file, read in place.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "ingest/zarr/store/zarr_store.h"

namespace weir {

/// Stored entries are read in parts, deflated ones as a whole: both are checked against their CRC-32 where they are
/// read as a whole. Throws what read_zip_directory throws; of `memory`, the directory may take a sixteenth.
std::unique_ptr<ZarrStore> make_zip_store(const std::string& path, std::uint64_t memory);

}  // namespace weir
