// Raw volumes: values in file order, x fastest, after an optional header.
#pragma once

#include <memory>
#include <string>

#include "ingest/source/source_options.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// Opens `path` and checks its size against the extent. Reads no value yet. The source needs up to kStagingBytes
/// (ingest/plan/staging.h) besides the caller's buffers. Throws Error(usage) if an option contradicts the name, or if
/// the extent or type is neither given nor in the name. Throws Error(input) if the file is missing, a directory,
/// unreadable or empty, the extent is impossible, or the size does not match it.
std::unique_ptr<VolumeSource> open_raw(const std::string& path, const SourceOptions& options);

}  // namespace weir
