// Runs the work of a brick cache on the current device, in the order of the calling thread's default stream.
#pragma once

#include <cstdint>
#include <string_view>

#include "format/nanovdb/macrocells.h"
#include "gpu/cuda/runtime/device_array.h"
#include "gpu/cuda/runtime/launch_kernel.cuh"
#include "gpu/math/portable.h"

namespace weir {

inline constexpr unsigned kStepThreads = 256;

/// One thread of a group.
struct StepThread {
  __device__ unsigned index() const { return threadIdx.x; }
  __device__ unsigned count() const { return blockDim.x; }
  __device__ void meet() const { __syncthreads(); }
  /// Returns the bounds of all threads' bounds. Only the first thread's result is valid. `of_warps` has one element
  /// per warp.
  __device__ MinMax widest(MinMax own, MinMax* of_warps) const {
    for (int distance = 16; distance > 0; distance /= 2) {
      own.min = lesser(own.min, __shfl_down_sync(~0U, own.min, distance));
      own.max = greater(own.max, __shfl_down_sync(~0U, own.max, distance));
    }
    if (threadIdx.x % 32 == 0) of_warps[threadIdx.x / 32] = own;
    __syncthreads();
    if (threadIdx.x == 0) {
      for (unsigned w = 1; w < blockDim.x / 32; ++w) {
        own = {lesser(own.min, of_warps[w].min), greater(own.max, of_warps[w].max)};
      }
    }
    return own;
  }
};

template <class Step>
__global__ void run_each(const __grid_constant__ Step step, std::uint32_t count) {
  const std::uint32_t i = blockIdx.x * kStepThreads + threadIdx.x;
  if (i < count) step(i);
}

template <class Step>
__global__ void run_groups(const __grid_constant__ Step step) {
  __shared__ typename Step::Shared shared;
  step(StepThread{}, shared, blockIdx.x);
}

struct DeviceMachine {
  static constexpr std::string_view kWorking = "working on bricks";

  template <class T>
  using Array = DeviceArray<T>;

  /// Runs step(i) for each i < count.
  template <class Step>
  void each(std::uint32_t count, const Step& step) const {
    if (count == 0) return;
    launch_kernel(kWorking, {(count + kStepThreads - 1) / kStepThreads, kStepThreads, cudaStreamPerThread},
                  run_each<Step>, step, count);
  }
  /// Runs step(thread, shared, g) by a group of threads for each g < count.
  template <class Step>
  void groups(std::uint32_t count, const Step& step) const {
    if (count == 0) return;
    launch_kernel(kWorking, {count, kStepThreads, cudaStreamPerThread}, run_groups<Step>, step);
  }
  /// Waits until all work is done.
  void wait() const { check_cuda(cudaStreamSynchronize(cudaStreamPerThread), kWorking); }
  template <class T>
  void clear(Array<T>& array) const {
    check_cuda(cudaMemsetAsync(array.data(), 0, array.bytes(), cudaStreamPerThread), "clearing device memory");
  }
};

}  // namespace weir
