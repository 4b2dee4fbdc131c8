// How many threads the system lets this process start.
#pragma once

#include <cstddef>

namespace weir {

/// At most `wanted` more threads can run at the same time: fewer where a limit (ulimit -u, pids.max of a container) is
/// near. Starts them to find out, 20 us each. What starts threads later, as oneTBB does, may end the process where it
/// cannot.
std::size_t startable_threads(std::size_t wanted);

}  // namespace weir
