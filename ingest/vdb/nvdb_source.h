// Opens NanoVDB volumes (.nvdb), written by weir or by NanoVDB's tools.
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

/// Recognises a file by its magic number or by its name.
bool recognises_nvdb(std::string_view path, std::span<const std::byte> head);

/// Opens the grid `options.dataset`, or the only grid that can be converted. weir converts float, Fp4, Fp8, Fp16 and
/// FpN grids without NanoVDB's own compression, and weir's packed grids. The domain is the bounding box of the active
/// voxels; inactive voxels in it read as a stock accessor reads them. Values are read by pread, so a file that
/// changes during the reading gives an error. place_grid() turns the grid's map into spacing and origin. A level set
/// keeps its class and background, a fog volume its class. Throws Error(usage) if several grids can be converted and
/// none is named, and Error(input) for files that NvdbGrid::open refuses and for grids without active voxels.
std::unique_ptr<VolumeSource> open_nvdb(const std::string& path, const SourceOptions& options);
std::vector<DatasetInfo> list_nvdb(const std::string& path, const SourceOptions& options);

}  // namespace weir
