// What a file holds, as `weir inspect` lists it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "ingest/source/volume_source.h"

namespace weir {

/// One array or grid of a file.
struct DatasetInfo {
  std::string name;                   ///< as --dataset takes it; empty where the file holds one volume and no name
  std::vector<std::int64_t> extents;  ///< as the file orders them: slowest axis first for HDF5, x first for headers
  std::string type;                   ///< "float32", "big-endian float64", ...
  std::string layout;                 ///< "contiguous", "chunked 64 x 64 x 64, gzip, shuffle", ...
  std::vector<std::pair<std::string, std::string>> attributes;  ///< those that matter: units, missing value, spacing
  std::size_t leading_axes = 0;                                 ///< how many positions --index must give
  std::string obstacle;                                         ///< why it cannot be converted; empty where it can
};

/// The list of a format whose files hold one volume: opens it and says what it is.
std::vector<DatasetInfo> list_single(const SourceInfo& info, std::string layout);

}  // namespace weir
