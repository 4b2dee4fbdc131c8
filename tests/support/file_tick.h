// Waits until the clock of file times has moved on. Two writes within one tick of this clock have the same time.
#pragma once

#include <chrono>
#include <thread>

namespace weir {

/// Waits for longer than a tick, which is at most 10 ms. Files that are written afterwards have a later time than files
/// that were written before.
inline void pass_file_tick() { std::this_thread::sleep_for(std::chrono::milliseconds(20)); }

}  // namespace weir
