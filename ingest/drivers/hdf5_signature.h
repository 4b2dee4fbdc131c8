// Which files are HDF5.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace weir {

/// Of the names of its files, in lower case.
inline constexpr std::array<std::string_view, 6> kHdf5Endings{".h5", ".hdf5", ".he5", ".nc", ".nc4", ".cdf"};

/// Whether the signature of HDF5 is at 0 or after a user block of 512, 1024, 2048 ... bytes.
bool has_hdf5_signature(const std::string& path);

/// Whether a file that begins so is NetCDF of before version 4.
bool is_classic_netcdf(std::span<const std::byte> head);

/// Files with the signature; and those that only look so, by a name (kHdf5Endings) or as NetCDF of
/// before version 4: open_hdf5_file has the messages for them.
bool recognises_hdf5(std::string_view path, std::span<const std::byte> head);

}  // namespace weir
