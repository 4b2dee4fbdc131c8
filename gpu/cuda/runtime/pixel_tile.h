// The pixels that a group of threads renders, and whether each thread has missed something.
#pragma once

#include "format/base/host_device.h"

namespace weir {

/// A warp renders 8 x 4 pixels, so that its rays stay together.
inline constexpr unsigned kTileWidth = 8;
inline constexpr unsigned kTileHeight = 16;

#if defined(__CUDACC__)
__device__ inline bool& missed_of_thread() {
  __shared__ bool missed[kTileWidth * kTileHeight];
  return missed[threadIdx.y * kTileWidth + threadIdx.x];
}
#endif

/// Returns whether this thread's look-ups have missed something since the flag was last set to false. Always false on
/// the host.
WEIR_HOST_DEVICE inline bool thread_missed() {
#if defined(__CUDA_ARCH__)
  return missed_of_thread();
#else
  return false;
#endif
}
WEIR_HOST_DEVICE inline void set_thread_missed([[maybe_unused]] bool missed) {
#if defined(__CUDA_ARCH__)
  missed_of_thread() = missed;
#endif
}

}  // namespace weir
