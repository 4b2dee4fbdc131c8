// Measures how long the device takes for work.
#pragma once

#include <cuda_runtime_api.h>

#include <algorithm>
#include <functional>
#include <vector>

#include "gpu/cuda/runtime/check.h"

namespace weir {

/// Returns the median time of several runs of the work that `work` puts into the calling thread's stream.
inline double device_seconds(const std::function<void()>& work) {
  constexpr int kRuns = 5;
  cudaEvent_t begin{};
  cudaEvent_t end{};
  check_cuda(cudaEventCreate(&begin), "creating an event");
  check_cuda(cudaEventCreate(&end), "creating an event");
  std::vector<double> seconds;
  for (int run = 0; run <= kRuns; ++run) {
    check_cuda(cudaEventRecord(begin, cudaStreamPerThread), "recording an event");
    work();
    check_cuda(cudaEventRecord(end, cudaStreamPerThread), "recording an event");
    check_cuda(cudaEventSynchronize(end), "waiting for the device");
    float ms = 0;
    check_cuda(cudaEventElapsedTime(&ms, begin, end), "reading an event");
    if (run > 0) seconds.push_back(static_cast<double>(ms) / 1e3);  // the first run loads the kernels
  }
  cudaEventDestroy(begin);
  cudaEventDestroy(end);
  std::ranges::sort(seconds);
  return seconds[seconds.size() / 2];
}

}  // namespace weir
