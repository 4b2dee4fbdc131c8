// Reads Zarr hierarchies, version 2 and 3: directories or zip files with chunked arrays, including images of
// OME-Zarr.
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

/// Returns whether `path` looks like Zarr: a directory that holds zarr.json, .zgroup or .zarray, one of these files
/// itself, a file that begins as a zip file (`head` is its first bytes), or a name that ends with .zip or .ozx.
bool recognises_zarr(std::string_view path, std::span<const std::byte> head);

/// Opens the array options.dataset, or the only array; of an image with several scales, the finest. The array's last
/// three axes are z, y, x; options.index is the position on the axes before them. Chunks that are not stored read as
/// the fill value, unless options.missing_chunks refuses them. Throws Error(usage), with the commands, if several
/// arrays can be converted and none is named. Also throws the errors of reading metadata and of scanning chunks.
std::unique_ptr<VolumeSource> open_zarr(const std::string& path, const SourceOptions& options);
std::vector<DatasetInfo> list_zarr(const std::string& path, const SourceOptions& options);

}  // namespace weir
