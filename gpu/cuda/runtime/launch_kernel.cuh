// Starts kernels in a way that does not mistake an older error of the calling thread for a refused start.
#pragma once

#include <cuda_runtime.h>

#include <cstddef>
#include <string_view>
#include <utility>

#include "gpu/cuda/runtime/check.h"

namespace weir {

struct LaunchShape {
  dim3 groups;
  dim3 threads;  ///< per group
  cudaStream_t stream;
  std::size_t shared_bytes = 0;
};

/// Starts `kernel`. Throws as check_cuda() does, with `what`. Leaves errors of earlier calls where they are.
/// cudaGetLastError() would return them, for example an error that the calling program's own allocation left.
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
