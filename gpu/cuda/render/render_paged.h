// The ray tracer on the device for volumes that may lack voxels. It draws the samples of a pixel in order, and
// repeats a sample that missed something. So the picture is the same as that of a complete volume.
#pragma once

#include <cuda_runtime_api.h>

#include <cstdint>

#include "gpu/cuda/bricks/page_table.h"
#include "gpu/render/render_task.h"

namespace weir {

/// The progress of a picture's pixels. All pointers are to device memory.
struct PagedPicture {
  struct Counts {
    std::uint64_t finished;    ///< samples finished in this launch
    std::uint32_t unfinished;  ///< pixels of the launched tiles that lack samples
    std::uint32_t missed;      ///< samples that must be drawn again
  };

  Float3* sums = nullptr;         ///< sums of the finished samples
  std::uint32_t* done = nullptr;  ///< finished samples of each pixel
  Counts* counts = nullptr;
  std::uint32_t first = 0;    ///< first sample
  std::uint32_t samples = 0;  ///< end of the samples
  std::uint32_t at_once = 1;  ///< most samples of a pixel in one launch
  bool keep_missed = false;   ///< a sample that missed something counts as finished, with approximate values
};

/// Returns the end of a picture's tile numbers. Tiles are numbered in an order that keeps neighbours together
/// (Morton's); some of these tiles lie outside the picture.
std::uint32_t paged_tiles(std::int32_t width, std::int32_t height);

/// Draws samples of the pixels of tiles [first_tile, first_tile + tiles) on `stream`. For PagedSampler, with or
/// without levels of detail. A sampler that notes by calling draws paths, the other one marches rays. Throws
/// Error(io) if the launch fails.
template <Noting kNoting, class Volume>
void launch_paged(const RenderTask<Volume>& task, const PagedPicture& picture, std::uint32_t first_tile,
                  std::uint32_t tiles, cudaStream_t stream);

}  // namespace weir
