// The ray tracer on the device.
#pragma once

#include <cuda_runtime_api.h>

#include "gpu/render/render_task.h"

namespace weir {

/// Adds samples [first, last) of every pixel to `sums` (device memory, width * height, rows from the top) on
/// `stream`. All pointers of `task` are device pointers. Instantiated for the volumes of device_samplers.h. Throws
/// Error(io) if the launch fails.
template <class Volume>
void launch_render(const RenderTask<Volume>& task, std::uint32_t first, std::uint32_t last, Float3* sums,
                   cudaStream_t stream);

}  // namespace weir
