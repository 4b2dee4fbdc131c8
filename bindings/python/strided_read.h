// Every n-th voxel along each axis: what an array's slices with steps ask for.
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
  std::int64_t step = 1;   ///< not 0; below 0 they fall
  std::int64_t count = 1;  ///< >= 1

  std::int64_t at(std::int64_t i) const { return first + i * step; }
};

/// The voxels at `axes` (x, y, z), x fastest; `values` holds exactly as many. All must lie in the volume. Leaves in
/// which none of them lies are not decoded where a step passes over them, and no more than some rows of leaves are held
/// besides `values`. Throws Error(interrupted) when cancelled, and what reading throws.
void read_strided(VolumeSource& source, const std::array<Stride, 3>& axes, std::span<float> values,
                  const std::atomic<bool>& cancelled);

/// The boxes of voxels, in index space, that read_strided reads of a volume whose lowest voxel has the index `origin`.
std::vector<Box> strided_boxes(const std::array<Stride, 3>& axes, const Index3& origin);

}  // namespace weir::python
