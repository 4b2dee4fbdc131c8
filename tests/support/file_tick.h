// Two writes within one tick of the clock of files have the same time.
#pragma once

#include <chrono>
#include <thread>

namespace weir {

/// What is written from here on has a later time than what was written before: waits for longer than a tick, which is
/// 10 ms at most.
inline void pass_file_tick() { std::this_thread::sleep_for(std::chrono::milliseconds(20)); }

}  // namespace weir
