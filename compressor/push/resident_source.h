// Opens a volume that lies on a device as the source of a conversion.
#pragma once

#include <memory>

#include "format/packed/block_coder.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// Returns a source over `resident`. `info` describes float32 values over resident->voxels(). The values are used as
/// they are.
std::unique_ptr<VolumeSource> open_resident(std::unique_ptr<ResidentVolume> resident, SourceInfo info);

}  // namespace weir
