// Opens HDF5 files (and NetCDF-4 files, which are HDF5) for reading, also while a simulation still writes them.
#pragma once

#include <cstdint>
#include <string>

#include "ingest/hdf5/file/hdf5_handle.h"

namespace weir {

/// The most bytes of an open file's metadata that the library caches.
inline constexpr std::uint64_t kHdf5MetadataBytes = std::uint64_t{4} << 20U;

/// Opens `path` for reading. If the file says that a writer is active, opens it beside the writer (SWMR). Throws
/// Error(input) if the file is not HDF5, is cut short or damaged, or if a program has it open for exclusive writing.
/// The caller holds Hdf5Lock.
Hdf5Handle open_hdf5_file(const std::string& path);

}  // namespace weir
