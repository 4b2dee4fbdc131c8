// OpenVDB volumes, .vdb.
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

/// Of the names of its files, in lower case.
inline constexpr std::array<std::string_view, 1> kVdbEndings{".vdb"};

/// By its magic or by the name.
bool recognises_vdb(std::string_view path, std::span<const std::byte> head);

/// The grid options.dataset, or the only one that can be converted: float, double, int32, int64, bool, mask, vec3s,
/// vec3d and vec3i grids, saved as 16-bit floats or not, by any of OpenVDB's compressions. The domain is the bounding
/// box of its active voxels; inactive ones in it read as OpenVDB reads them. The tree is loaded here and stays in
/// memory. A transform becomes spacing and origin as place_grid does it; a level set keeps its class and background, a
/// fog volume its class. Throws Error(usage) where options.memory does not hold the tree besides what the process
/// holds, or several grids can be converted and none is named; Error(input) for what read_vdb_header and walk_vdb_tree
/// refuse, other grids, frustums, and grids without active voxels.
std::unique_ptr<VolumeSource> open_vdb(const std::string& path, const SourceOptions& options);
std::vector<DatasetInfo> list_vdb(const std::string& path, const SourceOptions& options);

}  // namespace weir
