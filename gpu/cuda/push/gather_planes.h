// Copies planes of a strided array on the device to an array without gaps.
#pragma once

#include <cuda_runtime_api.h>

#include <cstddef>

#include "format/base/index.h"
#include "gpu/cuda/push/device_values.h"

namespace weir {

/// Queues in `stream` the copy of `extent` voxels to `to`, x fastest. `to` is device memory, or host memory that is
/// page-locked and mapped. Throws Error(io).
void gather_planes(const DeviceValues& from, const Index3& extent, std::byte* to, cudaStream_t stream);

}  // namespace weir
