// A volume that lies on a device, as a source of a conversion.
#pragma once

#include <memory>

#include "format/packed/block_coder.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// `info` is of float32 values over resident->voxels(), which are taken as they are.
std::unique_ptr<VolumeSource> open_resident(std::unique_ptr<ResidentVolume> resident, SourceInfo info);

}  // namespace weir
