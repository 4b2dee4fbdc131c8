#include "ingest/plan/block_stream.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>

#include "format/base/error.h"
#include "ingest/plan/block_parts.h"
#include "ingest/plan/page_buffer.h"

namespace weir {
namespace {

bool is_cancelled(const StreamOptions& options) {
  return options.cancel != nullptr && options.cancel->load(std::memory_order_relaxed);
}

constexpr std::size_t kBuffers = 2;

/// The hand-over between the reader and the caller: block i goes through buffer i % kBuffers, is read
/// after block i - kBuffers has been worked on, and worked on after it has been read.
class Handover {
 public:
  /// BlockReader: waits until block `i` may be read; false where the caller has stopped.
  bool wait_free(std::size_t i) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return stopped_ || i < worked_ + kBuffers; });
    return !stopped_;
  }
  void publish_read() {
    update([this] { ++read_; });
  }
  void publish_failure(std::exception_ptr failure) {
    update([&] { failure_ = std::move(failure); });
  }

  /// Caller: waits until block `i` has been read; rethrows what ended the reader before it.
  void wait_read(std::size_t i) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return failure_ || i < read_; });
    if (i >= read_) std::rethrow_exception(failure_);
  }
  void publish_worked() {
    update([this] { ++worked_; });
  }
  void stop() {
    update([this] { stopped_ = true; });
  }

 private:
  template <typename Change>
  void update(const Change& change) {
    {
      const std::lock_guard lock(mutex_);
      change();
    }
    changed_.notify_all();
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::size_t read_ = 0;    ///< blocks
  std::size_t worked_ = 0;  ///< blocks
  bool stopped_ = false;
  std::exception_ptr failure_;
};

/// The reading thread; told to stop and joined on every way out of stream_blocks.
class BlockReader {
 public:
  template <typename Run>
  BlockReader(Handover& handover, Run run) : handover_(handover), thread_(std::move(run)) {}
  ~BlockReader() { handover_.stop(); }  // thread_ joins after this
  BlockReader(const BlockReader&) = delete;
  BlockReader& operator=(const BlockReader&) = delete;

 private:
  Handover& handover_;
  std::jthread thread_;
};

// Between two blocks. A `cancel` that is set meanwhile is found at the next rest: whoever is asked last before the end
// knows that it is the end.
void rest(const StreamOptions& options, std::size_t boxes_done) {
  const bool ends = is_cancelled(options);
  if (options.at_rest && boxes_done > 0) options.at_rest(boxes_done);
  if (ends) throw Error(ErrorKind::interrupted, "interrupted");
}

// Boxes from `first` on that are worked on between two rests.
std::size_t end_of_group(std::span<const Box> boxes, std::size_t first) {
  constexpr std::int64_t kGroupVoxels = std::int64_t{64} << 20U;
  std::int64_t voxels = 0;
  std::size_t end = first;
  while (end < boxes.size() && voxels < kGroupVoxels) voxels += boxes[end++].voxels();
  return end;
}

// How the values of a box come, where that is in parts.
std::optional<BlockParts> parts_of(const VolumeSource& source, const Box& box) {
  std::vector<RepeatedPart> parts = source.repeated_parts(box);
  const bool repeats = std::any_of(parts.begin(), parts.end(), [](const RepeatedPart& part) { return part.repeats(); });
  return repeats ? std::optional(BlockParts(std::move(parts), box)) : std::nullopt;
}

}  // namespace

void throw_if_cancelled(const StreamOptions& options) {
  if (is_cancelled(options)) throw Error(ErrorKind::interrupted, "interrupted");
}

ConversionLoss stream_blocks(VolumeSource& source, std::span<const Box> boxes, const StreamOptions& options,
                             const std::function<void(const Block&)>& work) {
  throw_if_cancelled(options);
  ConversionLoss loss;
  if (boxes.empty()) return loss;

  std::int64_t total = 0;
  std::int64_t largest = 0;
  for (const Box& box : boxes) {
    total += box.voxels();
    largest = std::max(largest, box.voxels());
  }
  // A single box has nobody to read ahead for.
  const std::size_t bytes = static_cast<std::size_t>(largest) * sizeof(float);
  const std::array<PageBuffer, kBuffers> buffers{PageBuffer(bytes), PageBuffer(boxes.size() > 1 ? bytes : 0)};
  const auto values = [&](std::size_t i) {
    return buffers[i % kBuffers].floats().first(static_cast<std::size_t>(boxes[i].voxels()));
  };

  std::array<ConversionLoss, kBuffers> losses;
  std::array<std::optional<BlockParts>, kBuffers> parts;
  Handover handover;
  const BlockReader reader(handover, [&] {
    try {
      for (std::size_t i = 0; i < boxes.size() && handover.wait_free(i); ++i) {
        const TraceSpan span(options.trace, "read", values(i).size_bytes());
        std::optional<BlockParts>& in_parts = parts[i % kBuffers];
        in_parts = options.in_parts ? parts_of(source, boxes[i]) : std::nullopt;
        losses[i % kBuffers] = in_parts ? in_parts->read(source, values(i)) : source.read(boxes[i], values(i));
        handover.publish_read();
      }
    } catch (...) {
      handover.publish_failure(std::current_exception());
    }
  });

  std::int64_t done = 0;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    handover.wait_read(i);
    if (is_cancelled(options)) rest(options, i);
    const ConversionLoss lost = losses[i % kBuffers];
    loss.add(lost);
    const std::optional<BlockParts>& in_parts = parts[i % kBuffers];
    work({i, boxes[i], values(i), lost, in_parts ? &*in_parts : nullptr});
    handover.publish_worked();
    done += boxes[i].voxels();
    if (options.progress) options.progress(done, total);
    rest(options, i + 1);
  }
  return loss;
}

ConversionLoss work_in_place(VolumeSource& source, std::span<const Box> boxes, const StreamOptions& options,
                             const std::function<void(const Block&)>& work) {
  std::int64_t total = 0;
  std::int64_t largest = 0;
  for (const Box& box : boxes) {
    total += box.voxels();
    largest = std::max(largest, box.voxels());
  }
  ConversionLoss loss;
  std::int64_t done = 0;
  std::mutex mutex;
  const std::size_t bytes = static_cast<std::size_t>(largest) * sizeof(float);
  tbb::enumerable_thread_specific<PageBuffer> buffers([bytes] { return PageBuffer(bytes); });
  const auto work_on = [&](std::size_t i) {
    if (!options.at_rest) throw_if_cancelled(options);
    const std::span<float> values = buffers.local().floats().first(static_cast<std::size_t>(boxes[i].voxels()));
    const ConversionLoss lost = [&] {
      const TraceSpan span(options.trace, "read", values.size_bytes());
      return source.read_alone(boxes[i], values);
    }();
    work({i, boxes[i], values, lost});
    const std::lock_guard lock(mutex);
    loss.add(lost);
    done += boxes[i].voxels();
    if (options.progress) options.progress(done, total);
  };
  for (std::size_t first = 0; first < boxes.size();) {
    const std::size_t end = options.at_rest ? end_of_group(boxes, first) : boxes.size();
    tbb::parallel_for(first, end, work_on);
    rest(options, end);
    first = end;
  }
  return loss;
}

}  // namespace weir
