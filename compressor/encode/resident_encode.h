// The encode pass for packed blocks of a volume that lies on a device. The device gives streams and records, and values
// only of the blocks that it leaves to the host.
#pragma once

#include "compressor/encode/layer_encoder.h"
#include "format/packed/block_coder.h"
#include "ingest/plan/block_stream.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// Writes the same bytes as encode_leaves() for the same values. Where the device has no room or fails, the host reads
/// the values from `source`, which holds the same volume. Throws as encode_leaves.
void encode_resident(ResidentVolume& resident, VolumeSource& source, const EncodeTarget& target,
                     const StreamOptions& options);

}  // namespace weir
