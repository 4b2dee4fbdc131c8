// Scales the conversion times of a sample to its volume.
#pragma once

#include <cstddef>
#include <span>

#include "compressor/forecast/read_probe.h"
#include "compressor/leaf/encoding.h"

namespace weir {

/// Returns the time of work over `voxels`. It lies on the line through the sample (`sample_s` for `sample_voxels`) and
/// the median of its parts (`parts_s`, each for `part_voxels`). So the fixed time of each conversion does not count per
/// voxel. If there are no parts, or if they took as long as the sample, the time is in proportion to the sample.
double scaled_time(double sample_s, double sample_voxels, std::span<const double> parts_s, double part_voxels,
                   double voxels);

/// Returns whether parts of a sample, each of `part_voxels`, are converted as the volume is, so that their times can be
/// used. For packed parts of fewer than kLeastForecastBlocks blocks all rungs are built, which takes longer.
bool are_like_volume(Encoding encoding, double part_voxels);

/// Returns the time of a pass that works for `work_s` on `threads` threads and reads `voxels` at the same time. The
/// pass works while it waits for the disk, but a thread cannot decode and work at the same time.
double pass_time(double work_s, std::size_t threads, double voxels, const ReadCost& cost);

}  // namespace weir
