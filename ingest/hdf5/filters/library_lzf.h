// lzf for datasets that the HDF5 library reads itself: pieces of several, some components of each chunk, sources of
// virtual datasets. No library has this filter of h5py's.
#pragma once

#include <hdf5.h>

namespace weir {

inline constexpr H5Z_filter_t kLzfFilter = 32000;  ///< as h5py has registered it

/// Gives the library weir's decoder where it has none. The caller holds Hdf5Lock.
void offer_lzf();

/// Whether the library can undo the filter `id` of chunks that also went through filters which weir does not know. Not
/// lzf by weir's decoder: a filter before it may leave fewer bytes than a chunk has, by which damage is seen. The
/// caller holds Hdf5Lock.
bool library_undoes(H5Z_filter_t id);

}  // namespace weir
