// The tracer on the device where voxels may be missing: a pixel's samples are drawn in their order, and one that missed
// something is drawn again later, so that the picture is the one of a volume that is all there.
#pragma once

#include <cuda_runtime_api.h>

#include <cstdint>

#include "gpu/cuda/bricks/page_table.h"
#include "gpu/render/render_task.h"

namespace weir {

/// How far the pixels of a picture are; all in device memory.
struct PagedPicture {
  struct Counts {
    std::uint64_t finished;    ///< samples, in this launch
    std::uint32_t unfinished;  ///< pixels of the tiles launched that lack samples
    std::uint32_t missed;      ///< samples that are to be drawn again
  };

  Float3* sums = nullptr;         ///< of the samples done
  std::uint32_t* done = nullptr;  ///< samples of each pixel
  Counts* counts = nullptr;
  std::uint32_t first = 0;    ///< sample
  std::uint32_t samples = 0;  ///< beyond the last
  std::uint32_t at_once = 1;  ///< samples of a pixel in one launch, at most
  bool keep_missed = false;   ///< a sample that missed something counts as done, with what came near it
};

/// Tiles of a picture in an order that keeps neighbours together (Morton's): numbers below paged_tiles(), some of them
/// outside the picture.
std::uint32_t paged_tiles(std::int32_t width, std::int32_t height);

/// Draws samples of the pixels of tiles [first_tile, first_tile + tiles) on `stream`. For PagedSampler, with or without
/// levels of detail; paths where it notes by calling, rays that are marched where it does not. Throws Error(io) where
/// the launch fails.
template <Noting kNoting, class Volume>
void launch_paged(const RenderTask<Volume>& task, const PagedPicture& picture, std::uint32_t first_tile,
                  std::uint32_t tiles, cudaStream_t stream);

}  // namespace weir
