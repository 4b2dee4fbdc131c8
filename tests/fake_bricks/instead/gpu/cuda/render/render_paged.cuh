// In place of the kernels that draw volumes whose bricks come and go: pixels one after the other.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

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
  // A warp's pixels stay together: where one misses something, the others wait for it, at most a sample ahead.
  constexpr unsigned kWarpPixels = 32;
  constexpr unsigned kWarps = kTileWidth * kTileHeight / kWarpPixels;
  struct Pixel {
    std::int32_t x, y;
    std::int64_t index;
  };
  for (std::uint32_t warp = kWarps * first_tile; warp < kWarps * (first_tile + tiles); ++warp) {
    const std::uint32_t tile = warp / kWarps;
    std::vector<Pixel> pixels;
    std::uint32_t at = picture.samples;
    for (unsigned p = warp % kWarps * kWarpPixels; p < (warp % kWarps + 1) * kWarpPixels; ++p) {
      const auto x = every_second(tile) * static_cast<std::int32_t>(kTileWidth) + static_cast<std::int32_t>(p % 8);
      const auto y =
          every_second(tile >> 1U) * static_cast<std::int32_t>(kTileHeight) + static_cast<std::int32_t>(p / 8);
      if (x >= task.width || y >= task.height) continue;
      pixels.push_back({x, y, static_cast<std::int64_t>(y) * task.width + x});
      at = std::min(at, picture.done[pixels.back().index]);
    }
    const std::uint32_t last = std::min(picture.samples, at + picture.at_once);
    for (bool waits = false; at < last && !waits; ++at) {
      for (const Pixel& pixel : pixels) {
        if (picture.done[pixel.index] != at) continue;
        set_thread_missed(false);
        const Float3 added = render_sample(task, pixel.x, pixel.y, picture.first + at);
        if (thread_missed()) {
          ++picture.counts->missed;
          waits = waits || !picture.keep_missed;
          if (!picture.keep_missed) continue;
        }
        picture.sums[pixel.index] += added;
        ++picture.done[pixel.index];
        ++picture.counts->finished;
      }
    }
    for (const Pixel& pixel : pixels) picture.counts->unfinished += picture.done[pixel.index] < picture.samples ? 1 : 0;
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
