// How many threads the system lets this process start.
#pragma once

#include <chrono>
#include <cstddef>

#include "format/base/message.h"

namespace weir {

/// What an error says where a thread cannot be started.
inline constexpr const char* kNoMoreThreads =
    "no more threads can be started; raise the limit of processes (ulimit -u) or of address space (ulimit -v), or end "
    "some";

/// How long it counts that so many threads could be started: who pushes step after step asks before each.
inline constexpr std::chrono::seconds kStartableFor{1};

/// At most `wanted` more threads can run at the same time: fewer where a limit (ulimit -u, pids.max of a container) is
/// near. Starts them to find out, unless this process has done so within kStartableFor and has no more threads now: 30
/// to 46 us each for 7 to 133 of them on two cores. What starts threads later, as oneTBB does, may end the process
/// where it cannot.
std::size_t startable_threads(std::size_t wanted);

/// Workers, of which the calling thread is one, that can run beside what reads, writes back and saves: at most
/// `threads`, at least 1. Tells `notice`, where there is one, of fewer. Throws Error(io) where not one can read.
std::size_t startable_workers(std::size_t threads, const Notice& notice);

}  // namespace weir
