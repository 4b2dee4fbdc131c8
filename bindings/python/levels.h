// A volume at coarser levels of detail: level k has a value for each cube of 2^k voxels along an edge, the mean of
// them. Read in rows of leaves, so that no level holds more of the volume than a few of those.
#pragma once

#include <atomic>
#include <span>

#include "format/base/index.h"
#include "ingest/source/volume_source.h"

namespace weir::python {

/// Values along each axis at `level`: ceil(extent / 2^level).
Index3 level_extent(const Index3& extent, int level);
/// Levels until a single value is left, that one included.
int level_count(const Index3& extent);

/// The values of `box` at `level`, in values from the volume's lowest corner, x fastest. Level 0 are the voxels
/// themselves; above, a value is the mean of the voxels of its cube that the volume has, summed in double in the order
/// of z, y, x by blocks of 8 along z and y (so that threads do not matter), and NaN where one of them is.
/// Throws Error(interrupted) when cancelled, and what reading throws.
void read_level(VolumeSource& source, int level, const Box& box, std::span<float> values,
                const std::atomic<bool>& cancelled);

}  // namespace weir::python
