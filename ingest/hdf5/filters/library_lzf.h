// Gives the HDF5 library a decoder for h5py's filter lzf, which no library has. It serves datasets that the library
// reads itself: pieces of several chunks, some components of each chunk, sources of virtual datasets.
#pragma once

#include <hdf5.h>

namespace weir {

inline constexpr H5Z_filter_t kLzfFilter = 32000;  ///< as h5py has registered it

/// Registers weir's decoder if the library has none. The caller holds Hdf5Lock.
void offer_lzf();

/// Returns whether the library can undo the filter `id` for chunks that also have filters which weir does not know.
/// Returns false for lzf by weir's decoder: it recognises damage by a wrong chunk size, and an earlier filter may
/// leave fewer bytes than a chunk has. The caller holds Hdf5Lock.
bool library_undoes(H5Z_filter_t id);

}  // namespace weir
