// A source read into memory as a whole, as `weir render --volume dense` shows it.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "gpu/volume/dense_volume.h"
#include "ingest/plan/block_stream.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// Reads all of `source`. The background is the one that `weir convert` finds, so that the same scene shows the same;
/// voxels that the source declares missing become the background, as in a converted file. `options`.progress counts
/// the voxels of one pass. Throws Error(usage) with both figures where the system has not enough memory left or the
/// ceiling is lower, and as VolumeSource::read.
std::shared_ptr<const DenseVolume> read_dense(VolumeSource& source, const StreamOptions& options,
                                              std::optional<std::uint64_t> ceiling = std::nullopt);

}  // namespace weir
