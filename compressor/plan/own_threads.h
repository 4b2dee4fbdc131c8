// oneTBB's threads, in weir's floating-point mode.
#pragma once

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <cstddef>

#include "format/process/float_mode.h"

namespace weir {

/// Runs loops in weir's floating-point mode. A thread that has used oneTBB before has an arena with the floating-point
/// mode of that time, and every worker in that arena gets the same mode.
class OwnArena {
 public:
  /// Makes an arena of at most `threads` threads at a time, including the thread that calls run().
  explicit OwnArena(int threads = tbb::task_arena::automatic) : arena_(threads) {
    const FloatMode mode;
    arena_.initialize();  // with the mode of this thread
  }
  OwnArena(const OwnArena&) = delete;
  OwnArena& operator=(const OwnArena&) = delete;

  /// Calls work() and runs its loops in this arena. Returns what work() returns and throws what it throws.
  template <typename Work>
  auto run(const Work& work) {
    const FloatMode mode;
    return arena_.execute(work);
  }

 private:
  tbb::task_arena arena_;
};

/// The threads of one conversion. While the object lives, all oneTBB loops of the process together use at most
/// `threads` threads, because memory is planned for that number.
class OwnThreads {
 public:
  explicit OwnThreads(std::size_t threads)
      : limit_(tbb::global_control::max_allowed_parallelism, threads), arena_(static_cast<int>(threads)) {}

  /// Does the same as OwnArena::run().
  template <typename Work>
  auto run(const Work& work) {
    return arena_.run(work);
  }

 private:
  tbb::global_control limit_;
  OwnArena arena_;
};

}  // namespace weir
