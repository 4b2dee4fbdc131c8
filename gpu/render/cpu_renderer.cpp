#include "gpu/render/cpu_renderer.h"

#include <oneapi/tbb/blocked_range2d.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <mutex>
#include <optional>
#include <utility>

#include "format/base/error.h"
#include "format/process/fork_guard.h"

namespace weir {

namespace {

constexpr std::int32_t kTile = 16;            // pixels
constexpr std::uint32_t kSamplesPerPass = 4;  // one tile takes some milliseconds per pass

oneapi::tbb::task_arena make_arena(int threads) {
  return oneapi::tbb::task_arena(threads > 0 ? threads : oneapi::tbb::task_arena::automatic);
}

// Returns the picture that `options` continue, or an empty one. Without `kept`, the samples of each pixel are not
// counted.
KeptPixels begun_picture(const RenderFrame& frame, const CpuRenderOptions& options) {
  KeptPixels picture;
  if (options.kept != nullptr) picture = std::exchange(*options.kept, {});
  const bool same = picture.sums.width == frame.width && picture.sums.height == frame.height;
  if (picture.samples.empty() || !same) picture = {Image(frame.width, frame.height), {}};
  if (options.kept != nullptr) picture.samples.resize(picture.sums.pixels.size());
  return picture;
}

}  // namespace

std::size_t render_threads(int threads) { return static_cast<std::size_t>(make_arena(threads).max_concurrency()); }

template <class Volume>
Image render_cpu(const RenderTask<Volume>& task, const CpuRenderOptions& options) {
  return render_cpu(std::span(&task, 1), options);
}

template <class Volume>
Image render_cpu(std::span<const RenderTask<Volume>> tasks, const CpuRenderOptions& options) {
  const RenderFrame& frame = tasks.front();
  KeptPixels picture = begun_picture(frame, options);
  Image& image = picture.sums;
  std::atomic<std::uint64_t> done{0};
  std::mutex reporting;
  const auto cancelled = [&] { return options.cancel != nullptr && options.cancel->load(std::memory_order_relaxed); };

  const auto render_tile = [&](std::int32_t x0, std::int32_t x1, std::int32_t y0, std::int32_t y1, std::uint32_t first,
                               std::uint32_t last) {
    const auto thread = static_cast<std::size_t>(oneapi::tbb::this_task_arena::current_thread_index());
    const RenderTask<Volume>& task = tasks.size() == 1 ? tasks.front() : tasks[thread];
    for (std::int32_t y = y0; y < y1; ++y) {
      for (std::int32_t x = x0; x < x1; ++x) {
        if (cancelled()) return;  // a pixel of a dense volume may take milliseconds
        const std::size_t pixel = image.index(x, y);
        if (!picture.samples.empty()) {
          if (picture.samples[pixel] >= last) continue;  // drawn before the picture was cancelled
          picture.samples[pixel] = last;
        }
        for (std::uint32_t s = first; s < last; ++s) image.pixels[pixel] += render_sample(task, x, y, s);
      }
      done += static_cast<std::uint64_t>(x1 - x0) * (last - first);
      if (!options.progress) continue;
      if (const std::unique_lock lock(reporting, std::try_to_lock); lock) options.progress(done.load());
    }
  };

  // A caller that asks for more threads than cores gets them.
  std::optional<ForkGuard> forks;
  std::optional<oneapi::tbb::global_control> limit;
  if (options.threads > 0) {
    forks.emplace();
    limit.emplace(oneapi::tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(options.threads));
  }
  oneapi::tbb::task_arena arena = make_arena(options.threads);
  for (std::uint32_t first = 0; first < options.samples && !cancelled(); first += kSamplesPerPass) {
    const std::uint32_t last = std::min(first + kSamplesPerPass, options.samples);
    arena.execute([&] {
      const oneapi::tbb::blocked_range2d<std::int32_t> tiles(0, (frame.height + kTile - 1) / kTile, 1, 0,
                                                             (frame.width + kTile - 1) / kTile, 1);
      oneapi::tbb::parallel_for(tiles, [&](const auto& range) {
        for (std::int32_t ty = range.rows().begin(); ty < range.rows().end(); ++ty) {
          for (std::int32_t tx = range.cols().begin(); tx < range.cols().end(); ++tx) {
            render_tile(tx * kTile, std::min((tx + 1) * kTile, frame.width), ty * kTile,
                        std::min((ty + 1) * kTile, frame.height), first, last);
          }
        }
      });
    });
  }
  if (cancelled()) {
    if (options.kept != nullptr) *options.kept = std::move(picture);
    throw Error(ErrorKind::interrupted, "interrupted; no image was written");
  }
  const float scale = 1.0F / static_cast<float>(std::max(options.samples, 1U));
  for (Float3& pixel : image.pixels) pixel = pixel * scale;
  return std::move(picture.sums);
}

template <class Fine>
using Levelled = LevelledVolume<Fine, DenseSampler>;

template Image render_cpu(const RenderTask<VolumeSampler>& task, const CpuRenderOptions& options);
template Image render_cpu(const RenderTask<DenseSampler>& task, const CpuRenderOptions& options);
template Image render_cpu(const RenderTask<CachedSampler>& task, const CpuRenderOptions& options);
template Image render_cpu(std::span<const RenderTask<CachedSampler>> tasks, const CpuRenderOptions& options);
template Image render_cpu(const RenderTask<Levelled<VolumeSampler>>& task, const CpuRenderOptions& options);
template Image render_cpu(const RenderTask<Levelled<DenseSampler>>& task, const CpuRenderOptions& options);
template Image render_cpu(std::span<const RenderTask<Levelled<CachedSampler>>> tasks, const CpuRenderOptions& options);

}  // namespace weir
