// Kernels are started here, so that an older error of the calling thread is not taken for a refused start.
#pragma once

#include <cuda_runtime.h>

#include <cstddef>
#include <string_view>
#include <utility>

#include "gpu/cuda/runtime/check.h"

namespace weir {

struct LaunchShape {
  dim3 groups;
  dim3 threads;  ///< of each group
  cudaStream_t stream;
  std::size_t shared_bytes = 0;
};

/// Starts `kernel`. Throws as check_cuda, with `what`. Errors of earlier calls stay where they are: cudaGetLastError
/// would give those that the program before us, an allocation that it tried, say, has left.
template <typename... Parameters, typename... Arguments>
void launch_kernel(std::string_view what, const LaunchShape& shape, void (*kernel)(Parameters...),
                   Arguments&&... arguments) {
  cudaLaunchConfig_t config{};
  config.gridDim = shape.groups;
  config.blockDim = shape.threads;
  config.dynamicSmemBytes = shape.shared_bytes;
  config.stream = shape.stream;
  check_cuda(cudaLaunchKernelEx(&config, kernel, std::forward<Arguments>(arguments)...), what);
}

}  // namespace weir
