// Counts the chunks of an HDF5 dataset that were never written. The library silently returns the fill value for them.
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
  std::vector<hsize_t> first;  ///< first element of the first unwritten chunk, slowest axis first; empty: unknown
  bool elsewhere = false;      ///< counted over the whole dataset: all may lie outside the range
};

/// Counts the unwritten chunks, of `chunk` elements each, that have elements in `range`, which is not empty. If more
/// than 1,048,576 chunks have elements there, counts over all chunks of the dataset. If the file holds all chunks,
/// one look is enough. Messages begin with `where`. The caller holds Hdf5Lock. Throws Error(input).
UnwrittenChunks unwritten_chunks(hid_t dataset, const std::vector<hsize_t>& chunk, const ElementRange& range,
                                 const std::string& where);

/// Counts like the function above, for the chunks that have elements in `selected`: a selection in the dataset's
/// space that is not empty.
UnwrittenChunks unwritten_chunks(hid_t dataset, const std::vector<hsize_t>& chunk, hid_t selected,
                                 const std::string& where);

}  // namespace weir
