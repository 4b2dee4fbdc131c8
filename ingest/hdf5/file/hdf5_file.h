// HDF5 files (NetCDF-4 files are such), opened for reading, also while a
// simulation still writes them.
#pragma once

#include <cstdint>
#include <string>

#include "ingest/hdf5/file/hdf5_handle.h"

namespace weir {

/// What the library keeps of an open file's metadata, in bytes, at most.
inline constexpr std::uint64_t kHdf5MetadataBytes = std::uint64_t{4} << 20U;

/// Opens `path` for reading, beside a writer (SWMR) where the file says that one is there. Throws
/// Error(input) where it is no HDF5 file, cut short, damaged, or a program has it open for writing alone.
/// The caller holds Hdf5Lock.
Hdf5Handle open_hdf5_file(const std::string& path);

}  // namespace weir
