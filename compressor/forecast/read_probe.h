// What reading a volume costs that does not lie in memory: measured on blocks of it, as a conversion reads them.
#pragma once

#include "ingest/plan/block_plan.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// Of each voxel.
struct ReadCost {
  double wall_s = 0;
  double cpu_s = 0;  ///< of all threads: decoding
  double bytes = 0;  ///< that were read
};

/// Reads up to eight blocks of `plan`, spread over the volume, 64 MiB of float32 or one block at most.
ReadCost probe_reading(VolumeSource& source, const BlockPlan& plan);

}  // namespace weir
