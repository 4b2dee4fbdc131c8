// Recognises HDF5 files.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace weir {

/// Endings of HDF5 file names, in lower case.
inline constexpr std::array<std::string_view, 6> kHdf5Endings{".h5", ".hdf5", ".he5", ".nc", ".nc4", ".cdf"};

/// Returns whether the HDF5 signature is at byte 0 or after a user block of 512, 1024, 2048 ... bytes.
bool has_hdf5_signature(const std::string& path);

/// Returns whether `head` begins a NetCDF file of a version before 4.
bool is_classic_netcdf(std::span<const std::byte> head);

/// Returns whether a file has the signature, or only looks like HDF5: by its name (kHdf5Endings) or as NetCDF of a
/// version before 4. For these, open_hdf5_file has messages.
bool recognises_hdf5(std::string_view path, std::span<const std::byte> head);

}  // namespace weir
