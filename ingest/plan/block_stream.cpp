#include "ingest/plan/block_stream.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <optional>
#include <system_error>
#include <thread>
#include <vector>

#include "format/base/error.h"
#include "ingest/plan/block_parts.h"
#include "ingest/plan/page_buffer.h"

namespace weir {
namespace {

bool is_cancelled(const StreamOptions& options) {
  return options.cancel != nullptr && options.cancel->load(std::memory_order_relaxed);
}

/// The hand-over between the readers and the caller. With b buffers, block i uses buffer i % b. It is read after
/// block i - b has been worked on, and worked on after it has been read.
class Handover {
 public:
  Handover(std::size_t blocks, std::size_t buffers) : blocks_(blocks), buffers_(buffers), read_(buffers) {}

  /// Reader: waits until the next block may be read. Returns nullopt if there is none or the caller has stopped.
  std::optional<std::size_t> next_to_read() {
    std::unique_lock lock(mutex_);
    const std::size_t i = next_++;
    // A failure is rethrown when its block's turn comes, so the blocks before it are still read.
    const auto ends = [&] { return stopped_ || i >= blocks_ || (failure_ && failed_ < i); };
    changed_.wait(lock, [&] { return ends() || i < worked_ + buffers_; });
    const bool reads = !ends();
    return reads ? std::optional(i) : std::nullopt;
  }
  void publish_read(std::size_t i) {
    update([&] { read_[i % buffers_] = i + 1; });
  }
  void publish_failure(std::size_t i, std::exception_ptr failure) {
    update([&] {
      if (failure_ && failed_ < i) return;
      failure_ = std::move(failure);
      failed_ = i;
    });
  }

  /// Caller: waits until block `i` has been read. Rethrows the exception that ended its reader.
  void wait_read(std::size_t i) {
    std::unique_lock lock(mutex_);
    const auto is_read = [&] { return read_[i % buffers_] == i + 1; };
    changed_.wait(lock, [&] { return is_read() || (failure_ && failed_ <= i); });
    if (!is_read()) std::rethrow_exception(failure_);
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

  const std::size_t blocks_;
  const std::size_t buffers_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::size_t next_ = 0;           // the next block that no reader has taken
  std::vector<std::size_t> read_;  // per buffer: the block that it holds, counted from 1
  std::size_t worked_ = 0;         // number of blocks that were worked on
  bool stopped_ = false;
  std::exception_ptr failure_;  // exception of block failed_, the first that failed
  std::size_t failed_ = 0;
};

/// The reading threads. Every way out of stream_blocks stops and joins them.
class BlockReaders {
 public:
  /// `read(i)` reads block i.
  BlockReaders(std::size_t count, Handover& handover, const std::function<void(std::size_t)>& read)
      : handover_(handover) {
    threads_.reserve(count);
    try {
      while (threads_.size() < count) threads_.emplace_back([&handover, read] { run(handover, read); });
    } catch (const std::system_error&) {
      if (threads_.empty()) throw;  // otherwise the system has no more threads, and the readers that exist suffice
    }
  }
  ~BlockReaders() { handover_.stop(); }  // threads_ join after this
  BlockReaders(const BlockReaders&) = delete;
  BlockReaders& operator=(const BlockReaders&) = delete;

 private:
  static void run(Handover& handover, const std::function<void(std::size_t)>& read) {
    while (const std::optional<std::size_t> i = handover.next_to_read()) {
      try {
        read(*i);
        handover.publish_read(*i);
      } catch (...) {
        handover.publish_failure(*i, std::current_exception());
      }
    }
  }

  Handover& handover_;
  std::vector<std::jthread> threads_;
};

// Returns the number of buffers of `bytes` each for `blocks` blocks: one for the block that is worked on, the others
// for blocks that are read ahead.
std::size_t buffer_count(std::size_t blocks, std::size_t bytes, const StreamOptions& options) {
  constexpr std::size_t kMost = 8;
  return std::min(blocks, std::clamp<std::size_t>(options.buffer_bytes / bytes, 2, kMost));
}

// Returns 2 if possible, so that one reader begins a block while the other ends one. Returns 1 for chunked sources,
// because a chunk that two blocks share is decoded once only if the blocks are read one after the other, and for
// sources with reads that take memory of their own.
std::size_t reader_count(std::size_t buffers, const VolumeSource& source) {
  return buffers > 2 && source.access().chunk == Index3{} && source.working_bytes() == 0 ? 2 : 1;
}

// Rests between two blocks. A `cancel` that is set during at_rest takes effect at the next rest, so that the last
// at_rest call before the end already knows that it is the last.
void rest(const StreamOptions& options, std::size_t boxes_done) {
  const bool ends = is_cancelled(options);
  if (options.at_rest && boxes_done > 0) options.at_rest(boxes_done);
  if (ends) throw Error(ErrorKind::interrupted, "interrupted");
}

// Returns the end of the boxes, from `first` on, that are worked on between two rests.
std::size_t end_of_group(std::span<const Box> boxes, std::size_t first) {
  constexpr std::int64_t kGroupVoxels = std::int64_t{64} << 20U;
  std::int64_t voxels = 0;
  std::size_t end = first;
  while (end < boxes.size() && voxels < kGroupVoxels) voxels += boxes[end++].voxels();
  return end;
}

// Returns the parts of `box`, or nullopt if none of its voxels repeat.
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
  struct Buffer {
    PageBuffer memory;
    ConversionLoss loss;
    std::optional<BlockParts> parts;
    const HeldLeaves* held = nullptr;
  };
  const std::size_t bytes = static_cast<std::size_t>(largest) * sizeof(float);
  std::vector<Buffer> buffers;
  for (std::size_t i = buffer_count(boxes.size(), bytes, options); i > 0; --i)
    buffers.push_back({PageBuffer(bytes), {}, {}, nullptr});
  const auto buffer_of = [&](std::size_t i) -> Buffer& { return buffers[i % buffers.size()]; };
  const auto values = [&](std::size_t i) {
    return buffer_of(i).memory.floats().first(static_cast<std::size_t>(boxes[i].voxels()));
  };
  Handover handover(boxes.size(), buffers.size());
  const BlockReaders readers(reader_count(buffers.size(), source), handover, [&](std::size_t i) {
    Buffer& buffer = buffer_of(i);
    buffer.held = options.in_parts ? source.held(boxes[i]) : nullptr;
    buffer.parts.reset();
    buffer.loss = {};
    if (buffer.held != nullptr) return;
    const TraceSpan span(options.trace, "read", values(i).size_bytes());
    if (options.in_parts) buffer.parts = parts_of(source, boxes[i]);
    buffer.loss = buffer.parts ? buffer.parts->read(source, values(i)) : source.read(boxes[i], values(i));
  });

  std::int64_t done = 0;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    handover.wait_read(i);
    if (is_cancelled(options)) rest(options, i);
    const Buffer& buffer = buffer_of(i);
    loss.add(buffer.loss);
    work({i, boxes[i], values(i), buffer.loss, buffer.parts ? &*buffer.parts : nullptr, buffer.held});
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
