// Names of HDF5's filters by number, and where to get them.
#pragma once

#include <hdf5.h>

#include <string>
#include <string_view>

namespace weir {

/// Returns the name of filter `id`: "gzip", "blosc". For a number that is not in The HDF Group's registry, returns
/// `stored`, the name in the file.
std::string filter_name(H5Z_filter_t id, std::string_view stored);

/// Returns what the user can do if the library cannot run the filter: "install hdf5-filter-plugin-zfp-serial, or
/// ...".
std::string filter_remedy(H5Z_filter_t id);

}  // namespace weir
