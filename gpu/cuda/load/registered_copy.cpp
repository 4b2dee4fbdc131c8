#include "gpu/cuda/load/registered_copy.h"

#include <unistd.h>

#include <algorithm>
#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <optional>
#include <string>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "format/base/text.h"
#include "format/process/page_size.h"
#include "gpu/cuda/load/copy_event.h"
#include "gpu/cuda/load/load_chunks.h"
#include "gpu/cuda/load/registered_range.h"
#include "gpu/cuda/runtime/check.h"
#include "gpu/cuda/runtime/current_device.h"

namespace weir {
namespace {

constexpr std::size_t kChunksBeyondThreads = 3;  // one copies, one is unlocked, one waits for its copy
constexpr std::size_t kRegisterAhead = 4;        // chunks requested from the disk before a chunk is prepared

class Pipeline {
 public:
  explicit Pipeline(const CopyTask& task)
      : task_(task),
        context_(task.device),
        chunks_(plan_load_chunks(task.offset, task.bytes, page_bytes(), task.chunk_bytes)),
        most_locked_(static_cast<std::size_t>(task.threads) + kChunksBeyondThreads) {}

  CopyOutcome run() {
    std::vector<std::thread> threads;
    double copy_wait_s = 0;
    try {
      for (std::size_t k = 0; k < std::min(kRegisterAhead, chunks_.size()); ++k) prefetch(chunks_[k]);
      begin(threads);
      copy_wait_s = copy();
    } catch (...) {
      stop([this] { failure_ = std::current_exception(); });
    }
    double drain_s = 0;
    {
      const StageClock clock(drain_s);
      for (std::thread& thread : threads) thread.join();
    }
    stages_.copy_wait_s = copy_wait_s;
    stages_.drain_s = drain_s;
    if (!stopped_) return {"", stages_};
    // Running copies must end before their pages are unlocked. A failure of the device has been reported already.
    if (cudaStreamSynchronize(task_.stream) != cudaSuccess) cudaGetLastError();
    copying_.clear();
    locked_.clear();
    if (failure_) std::rethrow_exception(failure_);
    return {refusal_, {}};
  }

 private:
  struct LockedChunk {
    RegisteredRange range;
    LoadChunk chunk;
  };
  struct CopyingChunk {
    RegisteredRange range;
    CopyEvent done;
  };

  // Fewer preparing threads do the same work. Without one thread of each kind, another way may work.
  void begin(std::vector<std::thread>& threads) {
    try {
      threads.emplace_back([this] { run_stage(&Pipeline::retire); });
      for (int t = 0; t < task_.threads; ++t) threads.emplace_back([this] { run_stage(&Pipeline::prepare); });
    } catch (const std::system_error& error) {
      if (threads.size() < 2) stop([&] { refusal_ = cat("no thread can be started: ", error.code().message()); });
    }
  }

  void run_stage(void (Pipeline::*stage)()) {
    try {
      context_.enter();
      (this->*stage)();
    } catch (...) {
      stop([this] { failure_ = std::current_exception(); });
    }
  }

  // The first caller that stops the pipeline gives the reason.
  template <class Reason>
  void stop(Reason give_reason) {
    const std::lock_guard lock(mutex_);
    if (!stopped_) give_reason();
    stopped_ = true;
    changed_.notify_all();
  }

  void prefetch(const LoadChunk& chunk) const {
    const std::uint64_t bytes = chunk.copy_end - chunk.copy_begin;
    if (!task_.file.cached(chunk.copy_begin, bytes)) task_.file.prefetch(chunk.copy_begin, bytes);
  }

  void prepare() {
    LoadStages mine;
    while (const std::optional<std::size_t> k = claim()) {
      task_.check_cancelled();
      if (*k + kRegisterAhead < chunks_.size()) prefetch(chunks_[*k + kRegisterAhead]);
      const LoadChunk& chunk = chunks_[*k];
      {
        const StageClock clock(mine.populate_s);
        task_.file.populate(chunk.copy_begin, chunk.copy_end - chunk.copy_begin);
      }
      const StageClock clock(mine.register_s);
      std::string refusal;
      auto range = RegisteredRange::make({task_.file.bytes().data() + chunk.begin, chunk.end - chunk.begin},
                                         RegisteredRange::Use::copied, refusal);
      if (!range) {
        task_.file.check_unchanged();  // pages that are gone cannot be locked either
        stop([&] { refusal_ = refusal; });
        return;
      }
      const std::lock_guard lock(mutex_);
      locked_.push_back({std::move(*range), chunk});
      changed_.notify_all();
    }
    const std::lock_guard lock(mutex_);
    stages_.populate_s += mine.populate_s;
    stages_.register_s += mine.register_s;
  }

  // Claims the next chunk to prepare, as soon as one more may be locked.
  std::optional<std::size_t> claim() {
    std::unique_lock lock(mutex_);
    const auto all_claimed = [this] { return stopped_ || claimed_ == chunks_.size(); };
    changed_.wait(lock, [&] { return all_claimed() || claimed_ - retired_ < most_locked_; });
    if (all_claimed()) return std::nullopt;
    return claimed_++;
  }

  // Queues every copy. Returns the seconds that it waited for chunks.
  double copy() {
    double waited_s = 0;
    for (std::size_t copied = 0; copied < chunks_.size(); ++copied) {
      std::unique_lock lock(mutex_);
      {
        const StageClock clock(waited_s);
        changed_.wait(lock, [this] { return stopped_ || !locked_.empty(); });
      }
      if (stopped_) break;
      CopyEvent done;
      const LoadChunk& chunk = locked_.front().chunk;
      check_cuda(cudaMemcpyAsync(task_.target + (chunk.copy_begin - task_.offset),
                                 task_.file.bytes().data() + chunk.copy_begin, chunk.copy_end - chunk.copy_begin,
                                 cudaMemcpyHostToDevice, task_.stream),
                 "copying to the device");
      done.record(task_.stream);
      // Moved only now: if recording fails, the pages stay locked until run() has waited for the stream.
      copying_.push_back({std::move(locked_.front().range), std::move(done)});
      locked_.pop_front();
      changed_.notify_all();
    }
    return waited_s;
  }

  void retire() {
    while (retired_ < chunks_.size()) {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [this] { return stopped_ || !copying_.empty(); });
      if (stopped_) return;
      CopyingChunk& chunk = copying_.front();  // stays at its address while others are appended
      lock.unlock();
      chunk.done.wait();
      double unregister_s = 0;
      {
        const StageClock clock(unregister_s);
        chunk.range.release();
      }
      lock.lock();
      copying_.pop_front();
      ++retired_;
      stages_.unregister_s += unregister_s;
      changed_.notify_all();
    }
  }

  const CopyTask& task_;
  const SharedContext context_;
  const std::vector<LoadChunk> chunks_;
  const std::size_t most_locked_;

  std::mutex mutex_;  // guards the members below, except the front of copying_, which belongs to retire()
  std::condition_variable changed_;
  std::size_t claimed_ = 0;
  std::size_t retired_ = 0;
  std::deque<LockedChunk> locked_;
  std::deque<CopyingChunk> copying_;  // in the stream's order
  bool stopped_ = false;
  std::string refusal_;
  std::exception_ptr failure_;
  LoadStages stages_;
};

}  // namespace

CopyOutcome registered_copy(const CopyTask& task) { return Pipeline(task).run(); }

}  // namespace weir
