// Zarr hierarchies of version 2 and 3: directories or zip files with arrays in chunks, images of OME-Zarr among them.
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

/// A directory that holds zarr.json, .zgroup or .zarray, such a file itself, and a zip file, by its first bytes,
/// `head`; and what only looks so, by a name (.zip, .ozx).
bool recognises_zarr(std::string_view path, std::span<const std::byte> head);

/// The array options.dataset, or the only one; of an image of several scales the finest. Its last three axes are z, y,
/// x, options.index is the position on those before. Chunks that are not stored read as the fill value, unless
/// options.missing_chunks refuses them. Throws Error(usage) where several arrays can be converted and none is named,
/// with the commands, and what reading metadata and looking at chunks throws.
std::unique_ptr<VolumeSource> open_zarr(const std::string& path, const SourceOptions& options);
std::vector<DatasetInfo> list_zarr(const std::string& path, const SourceOptions& options);

}  // namespace weir
