// Reads every n-th voxel along each axis, for slices of an array with steps.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

#include "format/base/index.h"
#include "ingest/source/volume_source.h"

namespace weir::python {

/// The positions first, first + step, first + 2 step ... along one axis, in voxels from the volume's lowest one.
struct Stride {
  std::int64_t first = 0;
  std::int64_t step = 1;   ///< not 0; below 0 the positions fall
  std::int64_t count = 1;  ///< >= 1

  std::int64_t at(std::int64_t i) const { return first + i * step; }
};

/// Reads the voxels at `axes` (x, y, z), x fastest; `values` holds exactly as many. All must lie in the volume. Leaves
/// that a step passes over are not decoded, and only some rows of leaves are held besides `values`. Throws
/// Error(interrupted) when cancelled, and the exceptions of reading.
void read_strided(VolumeSource& source, const std::array<Stride, 3>& axes, std::span<float> values,
                  const std::atomic<bool>& cancelled);

/// Returns the boxes of voxels, in index space, that read_strided() reads of a volume with its lowest voxel at the
/// index `origin`.
std::vector<Box> strided_boxes(const std::array<Stride, 3>& axes, const Index3& origin);

}  // namespace weir::python
