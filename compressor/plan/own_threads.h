// oneTBB's threads, in weir's floating-point mode.
#pragma once

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <cstddef>

#include "format/process/float_mode.h"

namespace weir {

/// Loops in weir's floating-point mode. The calling thread's own arena, where it has used oneTBB before, has the mode
/// of that time, and gives it to all that work in it.
class OwnArena {
 public:
  /// Of at most `threads` at a time, of which one is whoever calls run().
  explicit OwnArena(int threads = tbb::task_arena::automatic) : arena_(threads) {
    const FloatMode mode;
    arena_.initialize();  // with the mode of this thread
  }
  OwnArena(const OwnArena&) = delete;
  OwnArena& operator=(const OwnArena&) = delete;

  /// work(), whose loops run here; returns what it returns, and throws what it throws.
  template <typename Work>
  auto run(const Work& work) {
    const FloatMode mode;
    return arena_.execute(work);
  }

 private:
  tbb::task_arena arena_;
};

/// The threads of one conversion. While it lives, all oneTBB loops of the process together use at most so many: memory
/// is planned for what so many threads hold.
class OwnThreads {
 public:
  explicit OwnThreads(std::size_t threads)
      : limit_(tbb::global_control::max_allowed_parallelism, threads), arena_(static_cast<int>(threads)) {}

  /// As OwnArena.
  template <typename Work>
  auto run(const Work& work) {
    return arena_.run(work);
  }

 private:
  tbb::global_control limit_;
  OwnArena arena_;
};

}  // namespace weir
