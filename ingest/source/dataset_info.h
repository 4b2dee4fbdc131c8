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
  std::string name;                   ///< as --dataset takes it; empty if the file holds a single volume without a name
  std::vector<std::int64_t> extents;  ///< as the file orders them: slowest axis first for HDF5, x first for headers
  std::string type;                   ///< "float32", "big-endian float64", ...; empty if the dataset cannot be opened
  std::string layout;                 ///< "contiguous", "chunked 64 x 64 x 64, gzip, shuffle", ...
  std::vector<std::pair<std::string, std::string>> attributes;  ///< the important ones: units, missing value, spacing
  std::size_t leading_axes = 0;                                 ///< how many positions --index must give
  std::vector<LeadingAxis> index_axes;                          ///< all axes that --index may give a position for
  std::vector<LeadingAxis> component_index_axes;                ///< index_axes if --component is given
  std::vector<LeadingAxis> vector_index_axes;  ///< index_axes if the components are the voxels along x instead
  bool index_by_name = false;           ///< not all of index_axes come before the volume's axes, so --index names them
  std::vector<std::string> axis_names;  ///< names of all axes that have a name in the file
  std::int64_t components = 1;          ///< if above 1, --component must choose among them
  bool by_name_only = false;            ///< read only if --dataset names it: a coarser scale of several
  std::string obstacle;                 ///< why it cannot be converted; empty if it can
  bool over_time = false;  ///< the obstacle is that it holds planes over time and has no third axis of space
};

/// The positions that --index stands for.
struct IndexPositions {
  std::vector<LeadingAxis> axes;
  std::vector<std::vector<std::int64_t>> positions;  ///< one on each axis; the last axis changes first
};

/// Returns the positions that options.index_choices stand for in one of the `datasets` of the file `path`. This
/// dataset is options.dataset or, if that is empty, the only convertible dataset whose axes the choices fit; if
/// options.component is given and some are arrays of vectors, only these count. The last axis of an array of
/// components is x if no component is chosen and each axis before the last three has its choice. Throws Error(usage)
/// if the dataset is unclear or the choices do not fit it, and what chosen_positions throws.
IndexPositions index_positions(const std::string& path, const std::vector<DatasetInfo>& datasets,
                               const SourceOptions& options);

/// Returns the list of the one dataset of a file that holds a single volume, from its `info` and `layout`.
std::vector<DatasetInfo> list_single(const SourceInfo& info, std::string layout);

}  // namespace weir
