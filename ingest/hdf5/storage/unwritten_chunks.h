// Chunks of an HDF5 dataset that nobody has written: the library gives the fill value for them, without a word.
#pragma once

#include <hdf5.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "ingest/hdf5/storage/storage.h"

namespace weir {

struct UnwrittenChunks {
  std::uint64_t count = 0;
  std::uint64_t all = 0;
  std::vector<hsize_t> first;  ///< first element of the first of them, slowest axis first, where they were looked up
};

/// Of the chunks of a dataset at the positions `leading` of its slowest axes, and all along the others; where these are
/// more than 65,536, of all its chunks. Where the file holds all of them that costs one look. Messages begin with
/// `where`. The caller holds Hdf5Lock. Throws Error(input).
UnwrittenChunks unwritten_chunks(hid_t dataset, const Storage& storage, std::span<const std::int64_t> leading,
                                 const std::string& where);

/// The same of the chunks, of `chunk` elements, in which `selected` has elements: a selection in the dataset's space
/// that is not empty.
UnwrittenChunks unwritten_chunks(hid_t dataset, const std::vector<hsize_t>& chunk, hid_t selected,
                                 const std::string& where);

}  // namespace weir
