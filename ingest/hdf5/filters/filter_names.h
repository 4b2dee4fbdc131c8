// HDF5's filters by number: what they are called and where to get them.
#pragma once

#include <hdf5.h>

#include <string>
#include <string_view>

namespace weir {

/// "gzip", "blosc"; of a number not registered with The HDF Group's list `stored`, the name in the file.
std::string filter_name(H5Z_filter_t id, std::string_view stored);

/// What to do where the library cannot run it: "install hdf5-filter-plugin-zfp-serial, or ...".
std::string filter_remedy(H5Z_filter_t id);

}  // namespace weir
