// The slowest way to the device; it works everywhere.
#pragma once

#include "gpu/cuda/load/copy_task.h"

namespace weir {

/// Reads at most task.chunk_bytes at a time into ordinary memory and copies them. Throws Error(input, io,
/// interrupted).
CopyOutcome pageable_copy(const CopyTask& task);

}  // namespace weir
