// Planes of a strided array, on the device, into an array without gaps.
#pragma once

#include <cuda_runtime_api.h>

#include <array>
#include <cstddef>
#include <cstdint>

#include "format/base/index.h"

namespace weir {

/// Where values are that the current device can read.
struct DeviceValues {
  const std::byte* first;              ///< voxel (0, 0, 0), a multiple of value_bytes
  std::array<std::int64_t, 3> stride;  ///< bytes from one voxel to the next along x, y, z: multiples of value_bytes
  std::size_t value_bytes;             ///< 1, 2, 4 or 8
};

/// Queues, in `stream`, the copy of `extent` voxels to `to`, x fastest; `to` is memory of the device, or host memory
/// that is page-locked and mapped. Throws Error(io).
void gather_planes(const DeviceValues& from, const Index3& extent, std::byte* to, cudaStream_t stream);

}  // namespace weir
