// Copies voxels from an array of any layout into an array without gaps.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "format/base/index.h"

namespace weir {

/// Where the voxels of `box` are in the caller's memory.
struct StridedVoxels {
  Box box;                             ///< index space
  const std::byte* first;              ///< voxel box.lo, at any alignment
  std::array<std::int64_t, 3> stride;  ///< bytes from one voxel to the next along x, y, z; any value
  std::size_t value_bytes;             ///< 1, 2, 4 or 8
};

/// Copies `part`, which lies in from.box, to `out`, x fastest. If the voxels are already contiguous in this order,
/// this is one copy.
void copy_voxels(const StridedVoxels& from, const Box& part, std::byte* out);

}  // namespace weir
