// How a dataset lies in its file: layout and filters, and what keeps its values
// from being read.
#pragma once

#include <hdf5.h>

#include <cstddef>
#include <string>
#include <vector>

namespace weir {

/// What messages say of a dataset whose index of chunks cannot be read; the library's reason follows.
inline constexpr const char* kUncountedChunks = "its chunks cannot be counted, the file is damaged or being written";

enum class StorageKind {
  contiguous,
  external,  ///< contiguous, in files of their own
  compact,   ///< in the dataset's header
  chunked,
  mapped  ///< "virtual": in other datasets
};

struct Storage {
  StorageKind kind = StorageKind::contiguous;
  std::vector<hsize_t> chunk;        ///< elements along each axis, slowest first; empty where not chunked
  std::vector<std::string> filters;  ///< in the order of writing: "shuffle", "gzip"
  std::vector<std::byte> fill;       ///< one stored value: what unwritten elements read as
  bool fill_is_set = false;          ///< whoever wrote the file chose it
  std::string obstacle;              ///< no value ever written, or a filter that is not there; else empty
  bool is_all_fill = false;          ///< no value was ever written, that is the obstacle, and `fill` is set for that

  /// "contiguous", "chunked 64 x 64 x 64, shuffle, gzip".
  std::string text() const;
};

/// The caller holds Hdf5Lock.
Storage storage_of(hid_t dataset);

}  // namespace weir
