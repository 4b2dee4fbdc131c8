// Measures the cost of reading a volume that does not lie in memory, on blocks of the size that a conversion reads.
#pragma once

#include "ingest/plan/block_plan.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// The cost of reading one voxel.
struct ReadCost {
  double wall_s = 0;
  double cpu_s = 0;  ///< CPU time of all threads, for decoding
  double bytes = 0;  ///< bytes read from the file
};

/// Reads up to eight blocks of `plan`, spread over the volume: at most 64 MiB of float32, or one block if it is larger.
ReadCost probe_reading(VolumeSource& source, const BlockPlan& plan);

}  // namespace weir
