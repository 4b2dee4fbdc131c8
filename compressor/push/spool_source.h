// A spooled volume as a source, which reads like a file that holds the same values.
#pragma once

#include <memory>

#include "compressor/push/leaf_spool.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// `info` of values that a simulation hands over, with format and file_bytes set. Throws Error(usage) where there are
/// too many of them.
SourceInfo as_pushed(SourceInfo info);

/// Reads what `spool`, which must outlive the source and have all voxels, holds of the volume that `info` describes.
/// bytes_read counts what came from the spool's file. Reading a leaf that was never written is Error(internal).
std::unique_ptr<VolumeSource> open_spool(const LeafSpool& spool, SourceInfo info);

}  // namespace weir
