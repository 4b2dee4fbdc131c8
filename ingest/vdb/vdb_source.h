// Opens OpenVDB volumes (.vdb).
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ingest/source/dataset_info.h"
#include "ingest/source/source_options.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// Endings of the file names, in lower case.
inline constexpr std::array<std::string_view, 1> kVdbEndings{".vdb"};

/// Recognises a file by its magic number or by its name.
bool recognises_vdb(std::string_view path, std::span<const std::byte> head);

/// Opens the grid `options.dataset`, or the only grid that can be converted. weir converts float, double, int32,
/// int64, bool, mask, vec3s, vec3d and vec3i grids, saved as 16-bit floats or not, with any of OpenVDB's
/// compressions. The domain is the bounding box of the active voxels; inactive voxels in it read as OpenVDB reads
/// them. This call loads the tree, which stays in memory. place_grid() turns the transform into spacing and origin. A
/// level set keeps its class and background, a fog volume its class. Throws Error(usage) if options.memory does not
/// hold the tree in addition to the process's memory, or if several grids can be converted and none is named. Throws
/// Error(input) for files that read_vdb_header() and walk_vdb_tree() refuse, for other grids, for frustums, and for
/// grids without active voxels.
std::unique_ptr<VolumeSource> open_vdb(const std::string& path, const SourceOptions& options);
std::vector<DatasetInfo> list_vdb(const std::string& path, const SourceOptions& options);

}  // namespace weir
