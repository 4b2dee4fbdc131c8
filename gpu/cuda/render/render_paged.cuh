// Defines launch_paged, for the files that instantiate it.
#pragma once

#include "gpu/cuda/bricks/paged_sampler.h"
#include "gpu/cuda/render/render_kernel.cuh"
#include "gpu/cuda/render/render_paged.h"
#include "gpu/cuda/runtime/launch_kernel.cuh"
#include "gpu/cuda/volume/device_samplers.h"
#include "gpu/volume/levelled_volume.h"

namespace weir {

/// Returns every second bit of `n`, packed together.
__device__ inline std::int32_t spread_bits(std::uint32_t n) {
  n &= 0x55555555U;
  n = (n | n >> 1U) & 0x33333333U;
  n = (n | n >> 2U) & 0x0F0F0F0FU;
  n = (n | n >> 4U) & 0x00FF00FFU;
  return static_cast<std::int32_t>((n | n >> 8U) & 0x0000FFFFU);
}

__device__ inline std::uint32_t least_of_warp(std::uint32_t n) {
  for (int distance = 16; distance > 0; distance /= 2) n = lesser(n, __shfl_xor_sync(~0U, n, distance));
  return n;
}

template <class Volume, bool kPath>
__global__ void __launch_bounds__(kTileWidth* kTileHeight, kPath ? kPathBlocks : 1)
    render_paged_kernel(const __grid_constant__ RenderTask<Volume> task, const __grid_constant__ PagedPicture picture,
                        std::uint32_t first_tile) {
  __shared__ PagedPicture::Counts counts;
  if (threadIdx.x == 0 && threadIdx.y == 0) counts = {};
  __syncthreads();
  const std::uint32_t tile = first_tile + blockIdx.x;
  const std::int32_t x =
      spread_bits(tile) * static_cast<std::int32_t>(kTileWidth) + static_cast<std::int32_t>(threadIdx.x);
  const std::int32_t y =
      spread_bits(tile >> 1U) * static_cast<std::int32_t>(kTileHeight) + static_cast<std::int32_t>(threadIdx.y);
  const bool inside = x < task.width && y < task.height;
  const std::int64_t pixel = static_cast<std::int64_t>(y) * task.width + x;
  const std::uint32_t before = inside ? picture.done[pixel] : picture.samples;
  Float3 sum = inside ? picture.sums[pixel] : Float3{};
  std::uint32_t done = before;
  // The pixels of a warp stay together. If one misses something, the others wait for it, at most one sample ahead.
  std::uint32_t at = least_of_warp(before);
  const std::uint32_t last = lesser(picture.samples, at + picture.at_once);
  for (bool waits = false; at < last && !waits; ++at) {
    bool missed = false;
    if (done == at) {
      set_thread_missed(false);
      const Float3 added = render_sample(task, kPath ? RenderMode::path : task.mode, x, y, picture.first + done);
      missed = thread_missed();
      if (missed) atomicAdd(&counts.missed, 1U);
      if (!missed || picture.keep_missed) {
        sum += added;
        ++done;
      }
    }
    waits = !picture.keep_missed && __any_sync(~0U, missed) != 0;
  }
  if (done > before) {
    picture.sums[pixel] = sum;
    picture.done[pixel] = done;
    atomicAdd(reinterpret_cast<unsigned long long*>(&counts.finished), static_cast<unsigned long long>(done - before));
  }
  if (done < picture.samples) atomicAdd(&counts.unfinished, 1U);
  __syncthreads();
  if (threadIdx.x == 0 && threadIdx.y == 0) {
    if (counts.finished > 0) {
      atomicAdd(reinterpret_cast<unsigned long long*>(&picture.counts->finished),
                static_cast<unsigned long long>(counts.finished));
    }
    if (counts.unfinished > 0) atomicAdd(&picture.counts->unfinished, counts.unfinished);
    if (counts.missed > 0) atomicAdd(&picture.counts->missed, counts.missed);
  }
}

template <Noting kNoting, class Volume>
void launch_paged(const RenderTask<Volume>& task, const PagedPicture& picture, std::uint32_t first_tile,
                  std::uint32_t tiles, cudaStream_t stream) {
  const dim3 threads(kTileWidth, kTileHeight);
  launch_kernel("starting the renderer", {tiles, threads, stream},
                render_paged_kernel<Volume, kNoting == Noting::called>, task, picture, first_tile);
}

template <Filter kFilter, Noting kNoting, class Positions>
using LevelledPages = LevelledVolume<PagedSampler<kFilter, kNoting, Positions>, TextureSampler>;

// Instantiates for a filter and a way of noting misses, with and without levels of detail.
#define WEIR_LAUNCH_PAGED(FILTER, NOTING, POSITIONS)                                                                   \
  template void launch_paged<NOTING>(const RenderTask<PagedSampler<FILTER, NOTING, POSITIONS>>&, const PagedPicture&,  \
                                     std::uint32_t, std::uint32_t, cudaStream_t);                                      \
  template void launch_paged<NOTING>(const RenderTask<LevelledPages<FILTER, NOTING, POSITIONS>>&, const PagedPicture&, \
                                     std::uint32_t, std::uint32_t, cudaStream_t)
#define WEIR_LAUNCH_PAGED_OF(POSITIONS)                              \
  WEIR_LAUNCH_PAGED(Filter::trilinear, Noting::called, POSITIONS);   \
  WEIR_LAUNCH_PAGED(Filter::trilinear, Noting::inlined, POSITIONS);  \
  WEIR_LAUNCH_PAGED(Filter::stochastic, Noting::called, POSITIONS);  \
  WEIR_LAUNCH_PAGED(Filter::stochastic, Noting::inlined, POSITIONS); \
  WEIR_LAUNCH_PAGED(Filter::nearest, Noting::called, POSITIONS);     \
  WEIR_LAUNCH_PAGED(Filter::nearest, Noting::inlined, POSITIONS)

}  // namespace weir
