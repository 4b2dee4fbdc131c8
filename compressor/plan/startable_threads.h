// How many threads the system lets this process start.
#pragma once

#include <chrono>
#include <cstddef>

#include "format/base/message.h"

namespace weir {

/// How long the result of startable_threads() stays valid. A program that pushes step after step asks before each step.
inline constexpr std::chrono::seconds kStartableFor{1};

/// Returns how many more threads can run at the same time, at most `wanted`; fewer if a limit (ulimit -u, pids.max of a
/// container) is near. Starts the threads to find out, unless this process has done so within kStartableFor and has no
/// more threads now. That takes 30 to 46 us a thread for 7 to 133 threads on two cores. Callers ask beforehand because
/// a library that starts threads later, as oneTBB does, may end the process if it cannot start one.
std::size_t startable_threads(std::size_t wanted);

/// Returns how many workers, including the calling thread, can run beside the threads that read, write back and save:
/// at most `threads`, at least 1. Tells `notice`, if not empty, when there are fewer. Throws Error(io) if fewer than
/// two threads can be started: one to read, and one that oneTBB may start for itself.
std::size_t startable_workers(std::size_t threads, const Notice& notice);

}  // namespace weir
