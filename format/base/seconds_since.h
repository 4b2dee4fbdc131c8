// Wall-clock seconds for reports.
#pragma once

#include <chrono>

namespace weir {

/// Returns the seconds between `start` and now.
inline double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace weir
