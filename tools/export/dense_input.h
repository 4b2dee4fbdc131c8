// Reads a whole source into memory, for `weir render --volume dense`.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "compressor/conversion_options.h"
#include "gpu/volume/dense_volume.h"
#include "ingest/plan/block_stream.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// Reads all of `source`. The background is the one that `weir convert` finds, so that the same scene looks the same.
/// Voxels that the source declares missing become the background, as in a converted file; with MissingPolicy::error,
/// throws Error(input) with their count. `options`.progress counts the voxels of one pass. Throws Error(usage) with
/// both figures if the system has too little memory left or `ceiling` is lower; also throws as VolumeSource::read.
std::shared_ptr<const DenseVolume> read_dense(VolumeSource& source, const StreamOptions& options, MissingPolicy missing,
                                              std::optional<std::uint64_t> ceiling = std::nullopt);

}  // namespace weir
