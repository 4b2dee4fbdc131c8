#include "gpu/cuda/load/parallel_read.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

#include "gpu/cuda/runtime/current_device.h"

namespace weir {
namespace {

constexpr std::uint64_t kReadAhead = 128ULL << 20U;  // bytes requested from the disk before a piece is read

}  // namespace

void for_each_piece(const CopyTask& task, std::uint64_t piece_bytes, int threads,
                    const std::function<void(int, const FilePiece&)>& take) {
  const SharedContext context(task.device);
  const std::uint64_t pieces = (task.bytes + piece_bytes - 1) / piece_bytes;
  std::atomic<std::uint64_t> next{0};
  std::mutex mutex;
  std::exception_ptr failure;
  const auto prefetch = [&task](std::uint64_t begin, std::uint64_t bytes) {
    if (begin >= task.bytes) return;
    bytes = std::min(bytes, task.bytes - begin);
    if (!task.file.cached(task.offset + begin, bytes)) task.file.prefetch(task.offset + begin, bytes);
  };
  const auto run = [&](int thread) {
    try {
      if (thread > 0) context.enter();  // the caller's thread is in the context already
      for (std::uint64_t k = next++; k < pieces; k = next++) {
        task.check_cancelled();
        prefetch(k * piece_bytes + kReadAhead, piece_bytes);
        take(thread, {k * piece_bytes, std::min(piece_bytes, task.bytes - k * piece_bytes)});
      }
    } catch (...) {
      next = pieces;
      const std::lock_guard lock(mutex);
      if (!failure) failure = std::current_exception();
    }
  };
  prefetch(0, kReadAhead);
  std::vector<std::thread> others;
  try {
    for (int thread = 1; thread < threads && static_cast<std::uint64_t>(thread) < pieces; ++thread) {
      others.emplace_back(run, thread);
    }
  } catch (const std::system_error&) {
    // Fewer threads read the same pieces.
  }
  run(0);
  for (std::thread& thread : others) thread.join();
  if (failure) std::rethrow_exception(failure);
}

}  // namespace weir
