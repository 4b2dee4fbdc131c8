// Helper for Asio timers that may be restarted after they have fired.
#pragma once

#include <boost/asio/steady_timer.hpp>
#include <chrono>

namespace weir {

/// Returns false if the timer was restarted after it had fired. Its handler may already have been queued at that
/// time, and is then called without an error.
inline bool is_over(const boost::asio::steady_timer& timer) {
  return timer.expiry() <= std::chrono::steady_clock::now();
}

}  // namespace weir
