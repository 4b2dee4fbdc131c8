// Chunks of an HDF5 dataset that nobody has written: the library gives the fill value for them, without a word.
#pragma once

#include <hdf5.h>

#include <cstdint>
#include <string>
#include <vector>

namespace weir {

/// Elements of a dataset from `lo` to `hi`, exclusive, slowest axis first.
struct ElementRange {
  std::vector<hsize_t> lo;
  std::vector<hsize_t> hi;
};

struct UnwrittenChunks {
  std::uint64_t count = 0;
  std::uint64_t all = 0;
  std::vector<hsize_t> first;  ///< first element of the first of them, slowest axis first, where they were looked up
  bool elsewhere = false;      ///< they are those of the whole dataset, and may all lie outside what was asked for
};

/// Of the chunks of a dataset, of `chunk` elements, that have elements in `range`, which is not empty; where these are
/// more than 1,048,576, of all its chunks. Where the file holds all of them that costs one look. Messages begin with
/// `where`. The caller holds Hdf5Lock. Throws Error(input).
UnwrittenChunks unwritten_chunks(hid_t dataset, const std::vector<hsize_t>& chunk, const ElementRange& range,
                                 const std::string& where);

/// The same of the chunks, of `chunk` elements, in which `selected` has elements: a selection in the dataset's space
/// that is not empty.
UnwrittenChunks unwritten_chunks(hid_t dataset, const std::vector<hsize_t>& chunk, hid_t selected,
                                 const std::string& where);

}  // namespace weir
