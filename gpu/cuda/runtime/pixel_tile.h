// The pixels that a group of threads renders.
#pragma once

namespace weir {

/// A warp is 8 x 4 pixels, whose rays stay together.
inline constexpr unsigned kTileWidth = 8;
inline constexpr unsigned kTileHeight = 16;

#if defined(__CUDACC__)
/// Whether this thread's look-ups have missed something since it was last set to false.
__device__ inline bool& thread_missed() {
  __shared__ bool missed[kTileWidth * kTileHeight];
  return missed[threadIdx.y * kTileWidth + threadIdx.x];
}
#endif

}  // namespace weir
