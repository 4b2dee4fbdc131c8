// The encode pass of packed blocks of a volume that lies on a device: streams and records come from there, not values.
#pragma once

#include "compressor/encode/layer_encoder.h"
#include "format/packed/block_coder.h"
#include "ingest/plan/block_stream.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// What encode_leaves() writes of the same values. What the device has no room for, or fails at, is done by reading
/// `source`, which has those values. Throws as encode_leaves.
void encode_resident(ResidentVolume& resident, VolumeSource& source, const EncodeTarget& target,
                     const StreamOptions& options);

}  // namespace weir
