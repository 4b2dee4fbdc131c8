// What a file holds, as `weir inspect` lists it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "ingest/source/source_options.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// One array or grid of a file.
struct DatasetInfo {
  std::string name;                   ///< as --dataset takes it; empty where the file holds one volume and no name
  std::vector<std::int64_t> extents;  ///< as the file orders them: slowest axis first for HDF5, x first for headers
  std::string type;                   ///< "float32", "big-endian float64", ...; empty where it cannot be opened
  std::string layout;                 ///< "contiguous", "chunked 64 x 64 x 64, gzip, shuffle", ...
  std::vector<std::pair<std::string, std::string>> attributes;  ///< those that matter: units, missing value, spacing
  std::size_t leading_axes = 0;                                 ///< how many positions --index must give
  std::vector<LeadingAxis> index_axes;                          ///< all axes that it may give one for
  std::vector<LeadingAxis> component_index_axes;                ///< the same where --component is given
  std::vector<LeadingAxis> vector_index_axes;  ///< the same where what would be components are voxels along x
  bool index_by_name = false;                  ///< not all of these come before those of the volume
  std::vector<std::string> axis_names;         ///< of all axes that the file gives a name
  std::int64_t components = 1;                 ///< more: --component must choose among them
  bool by_name_only = false;                   ///< read only where --dataset names it: a coarser one of several scales
  std::string obstacle;                        ///< why it cannot be converted; empty where it can
  bool over_time = false;  ///< the obstacle is that it has planes over time, and no third axis of space
};

/// The positions that --index stands for.
struct IndexPositions {
  std::vector<LeadingAxis> axes;
  std::vector<std::vector<std::int64_t>> positions;  ///< one on each axis; the last axis changes first
};

/// Those that options.index_choices stand for in one of `datasets`, of the file `path`: options.dataset, or the only
/// one that can be converted and whose axes they fit, of vectors where options.component is given and some are. The
/// last axis of an array of components is x where no component is chosen and each axis before the last three has its
/// choice. Throws Error(usage) where it is unclear which dataset is meant, where they do not fit it, and as
/// chosen_positions.
IndexPositions index_positions(const std::string& path, const std::vector<DatasetInfo>& datasets,
                               const SourceOptions& options);

/// The list of a format whose files hold one volume: opens it and says what it is.
std::vector<DatasetInfo> list_single(const SourceInfo& info, std::string layout);

}  // namespace weir
