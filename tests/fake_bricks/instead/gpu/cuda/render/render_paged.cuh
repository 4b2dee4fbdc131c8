// In place of the kernels that draw volumes whose bricks come and go: pixels one after the other.
#pragma once

#include "gpu/cuda/bricks/paged_sampler.h"
#include "gpu/cuda/render/render_kernel.cuh"
#include "gpu/cuda/render/render_paged.h"
#include "gpu/volume/levelled_volume.h"

namespace weir {

template <Noting kNoting, class Volume>
void launch_paged(const RenderTask<Volume>& task, const PagedPicture& picture, std::uint32_t first_tile,
                  std::uint32_t tiles, cudaStream_t /*stream*/) {
  test::launch();
  // Of Morton's order, the tile's place along an axis: every second bit.
  const auto every_second = [](std::uint32_t n) {
    std::int32_t bits = 0;
    for (unsigned b = 0; b < 16; ++b) bits |= static_cast<std::int32_t>(n >> (2 * b) & 1U) << b;
    return bits;
  };
  for (std::uint32_t tile = first_tile; tile < first_tile + tiles; ++tile) {
    for (std::int32_t p = 0; p < static_cast<std::int32_t>(kTileWidth * kTileHeight); ++p) {
      const std::int32_t x = every_second(tile) * static_cast<std::int32_t>(kTileWidth) + p % 8;
      const std::int32_t y = every_second(tile >> 1U) * static_cast<std::int32_t>(kTileHeight) + p / 8;
      if (x >= task.width || y >= task.height) continue;
      const std::int64_t pixel = static_cast<std::int64_t>(y) * task.width + x;
      std::uint32_t& done = picture.done[pixel];
      const std::uint32_t before = done;
      const std::uint32_t last = std::min(picture.samples, before + picture.at_once);
      while (done < last) {
        set_thread_missed(false);
        const Float3 added = render_sample(task, x, y, picture.first + done);
        if (thread_missed()) {
          ++picture.counts->missed;
          if (!picture.keep_missed) break;
        }
        picture.sums[pixel] += added;
        ++done;
      }
      picture.counts->finished += done - before;
      if (done < picture.samples) ++picture.counts->unfinished;
    }
  }
}

template <Filter kFilter, Noting kNoting, class Positions>
using LevelledPages = LevelledVolume<PagedSampler<kFilter, kNoting, Positions>, TextureSampler>;

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
