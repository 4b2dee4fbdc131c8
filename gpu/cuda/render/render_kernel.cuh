// Defines launch_render, for the files that instantiate it.
#pragma once

#include "gpu/cuda/render/render_kernel.h"
#include "gpu/cuda/runtime/launch_kernel.cuh"
#include "gpu/cuda/runtime/pixel_tile.h"
#include "gpu/cuda/volume/device_samplers.h"

namespace weir {

/// Blocks of threads that a multiprocessor holds at once while it traces paths. Paths wait for memory most of the
/// time. 64 registers per thread, with some of them spilled, are faster than all registers and fewer threads.
inline constexpr unsigned kPathBlocks = 8;

/// Path tracing has a separate kernel, because the registers of the other modes would cost it threads.
template <class Volume, bool kPath>
__global__ void __launch_bounds__(kTileWidth* kTileHeight, kPath ? kPathBlocks : 1)
    render_kernel(const __grid_constant__ RenderTask<Volume> task, std::uint32_t first, std::uint32_t last,
                  Float3* sums) {
  const auto x = static_cast<std::int32_t>(blockIdx.x * kTileWidth + threadIdx.x);
  const auto y = static_cast<std::int32_t>(blockIdx.y * kTileHeight + threadIdx.y);
  if (x >= task.width || y >= task.height) return;
  Float3& sum = sums[static_cast<std::int64_t>(y) * task.width + x];
  Float3 added = sum;
  for (std::uint32_t s = first; s < last; ++s) {
    added += render_sample(task, kPath ? RenderMode::path : task.mode, x, y, s);
  }
  sum = added;
}

template <class Volume>
void launch_render(const RenderTask<Volume>& task, std::uint32_t first, std::uint32_t last, Float3* sums,
                   cudaStream_t stream) {
  const dim3 threads(kTileWidth, kTileHeight);
  const dim3 blocks((static_cast<unsigned>(task.width) + kTileWidth - 1) / kTileWidth,
                    (static_cast<unsigned>(task.height) + kTileHeight - 1) / kTileHeight);
  const auto kernel = task.mode == RenderMode::path ? &render_kernel<Volume, true> : &render_kernel<Volume, false>;
  launch_kernel("starting the renderer", {blocks, threads, stream}, kernel, task, first, last, sums);
}

}  // namespace weir
