// NanoVDB volumes, .nvdb: weir's own and those of NanoVDB's tools.
#pragma once

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

/// By its magic or by the name.
bool recognises_nvdb(std::string_view path, std::span<const std::byte> head);

/// The grid options.dataset, or the only one that can be converted: float, Fp4, Fp8, Fp16 and FpN grids without
/// NanoVDB's own compression, and weir's packed grids. The domain is the bounding box of its active voxels; inactive
/// ones in it read as a stock accessor reads them. Values are read by pread: a file that changes meanwhile is an error.
/// The grid's map becomes spacing and origin as place_grid does it; a level set keeps its class and background, a fog
/// volume its class. Throws Error(usage) where several grids can be converted and none is named; Error(input) for what
/// NvdbGrid::open refuses and grids without active voxels.
std::unique_ptr<VolumeSource> open_nvdb(const std::string& path, const SourceOptions& options);
std::vector<DatasetInfo> list_nvdb(const std::string& path, const SourceOptions& options);

}  // namespace weir
