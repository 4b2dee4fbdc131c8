// Opens a spooled volume as a source that reads like a file with the same values.
#pragma once

#include <memory>

#include "compressor/push/leaf_spool.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// Returns `info`, which describes values that a simulation hands over, with format and file_bytes set. Throws
/// Error(usage) if there are too many values.
SourceInfo as_pushed(SourceInfo info);

/// Returns a source that reads the volume that `info` describes from `spool`. The spool must have all voxels and
/// outlive the source. bytes_read() counts the bytes from the spool's file. Reading a leaf that was never written
/// throws Error(internal).
std::unique_ptr<VolumeSource> open_spool(const LeafSpool& spool, SourceInfo info);

}  // namespace weir
