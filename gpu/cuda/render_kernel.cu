// The tracer for the device: one thread a pixel.
#include "gpu/render_task.h"
#include "gpu/volume_sampler.h"

namespace weir {

/// Adds samples [first, last) of every pixel to `sums`, width * height, rows from the top.
__global__ void render_kernel(RenderTask<VolumeSampler> task, std::uint32_t first, std::uint32_t last, Float3* sums) {
  const auto x = static_cast<std::int32_t>(blockIdx.x * blockDim.x + threadIdx.x);
  const auto y = static_cast<std::int32_t>(blockIdx.y * blockDim.y + threadIdx.y);
  if (x >= task.width || y >= task.height) return;
  Float3& sum = sums[static_cast<std::int64_t>(y) * task.width + x];
  for (std::uint32_t s = first; s < last; ++s) sum += render_sample(task, x, y, s);
}

}  // namespace weir
