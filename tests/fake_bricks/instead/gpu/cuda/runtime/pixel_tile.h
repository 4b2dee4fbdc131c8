// In place of the device's: a pixel at a time, on the thread of the host that calls.
#pragma once

namespace weir {

inline constexpr unsigned kTileWidth = 8;
inline constexpr unsigned kTileHeight = 16;

inline bool& missed_of_thread() {
  thread_local bool missed = false;
  return missed;
}
inline bool thread_missed() { return missed_of_thread(); }
inline void set_thread_missed(bool missed) { missed_of_thread() = missed; }

}  // namespace weir
