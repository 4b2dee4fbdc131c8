// Draws samples of a picture of a volume whose bricks come and go.
#pragma once

#include <cuda_runtime_api.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <span>
#include <utility>

#include "format/base/error.h"
#include "format/base/message.h"
#include "format/base/seconds_since.h"
#include "gpu/cuda/bricks/brick_cache.h"
#include "gpu/cuda/render/render_paged.h"
#include "gpu/cuda/runtime/device_array.h"

namespace weir {

/// Roughly how long one launch may delay a cancellation.
inline constexpr double kLaunchSeconds = 0.05;

/// The work of a picture.
struct PagedReport {
  std::uint64_t turns = 0;          ///< turns that brought bricks in; for benchmarks
  std::uint64_t bricks = 0;         ///< bricks brought in
  std::uint64_t decoded = 0;        ///< blocks decoded
  std::uint64_t evicted = 0;        ///< bricks evicted
  std::uint32_t least_tiles = ~0U;  ///< fewest tiles in one launch; for benchmarks
};

/// The work of a draft.
struct DraftReport {
  std::uint64_t bricks = 0;   ///< bricks brought in
  std::uint64_t evicted = 0;  ///< bricks evicted
  std::uint32_t missed = 0;   ///< pixels whose last sample lacked some bricks
};

/// Adds samples [first, last) of every pixel to `sums` without waiting for bricks. A missing brick is replaced by a
/// level of detail or by its mean; it is there for the next sample if the cache can hold what one sample needs. For
/// pictures of a moving camera. `task_of` and `report_done` are as for trace_paged(). Throws the errors of
/// BrickCache::serve and check.
template <class Sampler, class TaskOf, class Done>
DraftReport trace_draft(BrickCache& cache, const TaskOf& task_of, std::uint32_t first, std::uint32_t last,
                        DeviceArray<Float3>& sums, const Done& report_done) {
  DraftReport report;
  auto task = task_of(cache.template paged_sampler<Sampler>());
  DeviceArray<std::uint32_t> done(sums.size());
  DeviceArray<PagedPicture::Counts> counts(1);
  for (std::uint32_t sample = first; sample < last; ++sample) {
    check_cuda(cudaMemsetAsync(done.data(), 0, done.bytes(), cudaStreamPerThread), "clearing the picture");
    check_cuda(cudaMemsetAsync(counts.data(), 0, counts.bytes(), cudaStreamPerThread), "clearing the picture");
    PagedPicture picture{sums.data(), done.data(), counts.data(), sample, 1, 1};
    picture.keep_missed = true;
    launch_paged<Sampler::Blocks::kNotes>(task, picture, 0, paged_tiles(task.width, task.height), cudaStreamPerThread);
    PagedPicture::Counts found{};
    counts.download(std::span(&found, 1));
    report.missed = found.missed;
    report_done(found.finished);
    if (found.missed == 0) continue;
    const PagingTurn turn = cache.serve();
    report.bricks += turn.bricks;
    report.evicted += turn.evicted;
    if (turn.unfit) task = task_of(cache.template paged_sampler<Sampler>());
  }
  if (report.bricks > 0) cache.check();
  return report;
}

/// Adds samples [first, last) of every pixel to `sums` (zeros), in order. If the picture needs more bricks than the
/// cache holds, draws one group of tiles after the other. `Sampler` is the cache's, and `task_of(sampler)` makes the
/// picture's task. Calls report_done(n) for n further samples of one pixel. Throws Error(usage) if the cache cannot
/// hold what the smallest tile needs, and the errors of BrickCache::serve and check.
template <class Sampler, class TaskOf, class Done>
PagedReport trace_paged(BrickCache& cache, const TaskOf& task_of, std::uint32_t first, std::uint32_t last,
                        DeviceArray<Float3>& sums, const std::atomic<bool>* cancel, const Done& report_done) {
  // A turn of the smallest tile that finishes no sample and finds the cache too small counts 1, or kInVain if it brings
  // nothing in. Any other turn restarts the count at 0. A count above kPatience is an error.
  constexpr std::uint32_t kPatience = 512;
  constexpr std::uint32_t kInVain = 64;
  PagedReport report;
  auto task = task_of(cache.template paged_sampler<Sampler>());
  const std::uint32_t tiles = paged_tiles(task.width, task.height);
  DeviceArray<std::uint32_t> done(sums.size());
  DeviceArray<PagedPicture::Counts> counts(1);
  const auto clear = [](auto& array) {
    check_cuda(cudaMemsetAsync(array.data(), 0, array.bytes(), cudaStreamPerThread), "clearing the picture");
  };
  clear(done);
  PagedPicture picture{sums.data(), done.data(), counts.data(), first, last - first, 1};
  std::uint64_t decoded_before = cache.counters().decoded;
  std::uint32_t at = 0;
  std::uint32_t count = tiles;
  std::uint64_t brought = 0;  // bricks brought in for these tiles
  std::uint32_t idle = 0;
  std::uint64_t drawn = 0;     // samples
  std::uint64_t reported = 0;  // samples reported so far
  while (at < tiles) {
    if (cancel != nullptr && cancel->load(std::memory_order_relaxed)) break;
    clear(counts);
    const auto start = std::chrono::steady_clock::now();
    launch_paged<Sampler::Blocks::kNotes>(task, picture, at, count, cudaStreamPerThread);
    PagedPicture::Counts found{};
    counts.download(std::span(&found, 1));
    report.least_tiles = std::min(report.least_tiles, count);
    drawn += found.finished;
    if (drawn > reported) report_done(drawn - std::exchange(reported, drawn));
    const double seconds = seconds_since(start);
    if (seconds > kLaunchSeconds) picture.at_once = std::max(1U, picture.at_once / 2);
    if (found.missed == 0) {
      if (seconds < kLaunchSeconds / 2) picture.at_once = std::min(2 * picture.at_once, 1U << 16U);
      if (found.unfinished > 0) continue;
      at += count;
      if (brought < cache.bricks() / 4) {
        count *= 2;
        picture.at_once = std::max(1U, picture.at_once / 2);
      }
      count = std::min(count, tiles - at);
      brought = 0;
      continue;
    }
    const PagingTurn turn = cache.serve();
    ++report.turns;
    report.bricks += turn.bricks;
    report.evicted += turn.evicted;
    brought += turn.bricks;
    if (turn.unfit) {
      task = task_of(cache.template paged_sampler<Sampler>());
      clear(done);
      clear(sums);
      drawn = 0;
      decoded_before = 0;
      brought = 0;
      picture.at_once = 1;
      at = 0;
      count = tiles;
      continue;
    }
    const bool stuck = found.finished == 0 && turn.crowded() && count == 1;
    idle = stuck ? idle + (turn.bricks + turn.pages == 0 ? kInVain : 1) : 0;
    if (turn.crowded()) count = std::max(1U, count / 2);
    if (idle > kPatience) {
      check_cuda(cudaStreamSynchronize(cudaStreamPerThread), "bringing bricks in");
      throw Error(ErrorKind::usage,
                  compose("the device holds ", cache.bricks(), " bricks, fewer than a few rays of this picture need;",
                          " give more ", option("device-memory")));
    }
  }
  cache.check();
  report.decoded = cache.counters().decoded - decoded_before;
  return report;
}

}  // namespace weir
