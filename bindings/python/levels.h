// A volume at coarser levels of detail: a value of level k is the mean of a cube of 2^k voxels along an edge. Levels
// are read in rows of leaves, so that only a few rows of the volume are in memory.
#pragma once

#include <atomic>
#include <span>

#include "format/base/index.h"
#include "ingest/source/volume_source.h"

namespace weir::python {

/// Returns the number of values along each axis at `level`: ceil(extent / 2^level).
Index3 level_extent(const Index3& extent, int level);
/// Returns the number of levels down to a single value, including that level.
int level_count(const Index3& extent);

/// Reads the values of `box` at `level`, in values from the volume's lowest corner, x fastest. Level 0 is the voxels
/// themselves. Above, a value is the mean of its cube's voxels in the volume, and NaN if one of them is NaN. It is
/// summed in double in the order of z, y, x, by blocks of 8 along z and y, so that threads do not change it. Throws
/// Error(interrupted) when cancelled, and the exceptions of reading.
void read_level(VolumeSource& source, int level, const Box& box, std::span<float> values,
                const std::atomic<bool>& cancelled);

}  // namespace weir::python
