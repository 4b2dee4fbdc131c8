// From the times of a sample to those of its volume.
#pragma once

#include <cstddef>
#include <span>

#include "compressor/forecast/read_probe.h"
#include "compressor/leaf/encoding.h"

namespace weir {

/// Time of work over `voxels`: on the line through `sample_s`, of `sample_voxels`, and the median of `parts_s`, each of
/// `part_voxels`, so that what every conversion takes does not count for each voxel. In proportion to the sample where
/// there are no parts, or where they took as long.
double scaled_time(double sample_s, double sample_voxels, std::span<const double> parts_s, double part_voxels,
                   double voxels);

/// Whether parts of a sample, each of `part_voxels`, are converted the way its volume is, so that their times tell: of
/// packed ones of few blocks (kLeastForecastBlocks) all rungs are built, which takes longer.
bool are_like_volume(Encoding encoding, double part_voxels);

/// Time of a pass that works for `work_s` on `threads` threads and reads `voxels` meanwhile: while it waits for a
/// device it works, but it cannot decode and work at a time.
double pass_time(double work_s, std::size_t threads, double voxels, const ReadCost& cost);

}  // namespace weir
