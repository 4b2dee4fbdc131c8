// Timers of Asio that are set anew while they may have fired.
#pragma once

#include <boost/asio/steady_timer.hpp>
#include <chrono>

namespace weir {

/// Whether a timer that has fired was not set anew since: its handler, which comes without an error then, too, may have
/// been waiting.
inline bool is_over(const boost::asio::steady_timer& timer) {
  return timer.expiry() <= std::chrono::steady_clock::now();
}

}  // namespace weir
