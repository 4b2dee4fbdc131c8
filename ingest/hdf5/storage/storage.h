// How a dataset is stored in its file: layout, filters, and the reason if its values cannot be read.
#pragma once

#include <hdf5.h>

#include <cstddef>
#include <string>
#include <vector>

namespace weir {

/// The message for a dataset with an unreadable chunk index; the library's reason follows.
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
  std::vector<hsize_t> chunk;        ///< elements along each axis, slowest first; empty if not chunked
  std::vector<std::string> filters;  ///< in the order of writing: "shuffle", "gzip"
  std::vector<std::byte> fill;       ///< one stored value, read for unwritten elements
  bool fill_is_set = false;          ///< the writer of the file chose `fill`
  std::string obstacle;              ///< no value ever written, or a filter that is not there; else empty
  bool is_all_fill = false;          ///< no value was ever written (this is the obstacle), and `fill` is set

  /// Returns "contiguous", "chunked 64 x 64 x 64, shuffle, gzip".
  std::string text() const;
};

/// The caller holds Hdf5Lock.
Storage storage_of(hid_t dataset);

}  // namespace weir
