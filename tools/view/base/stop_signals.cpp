#include "tools/view/base/stop_signals.h"

#include <csignal>
#include <utility>

namespace weir {

StopSignals::StopSignals(boost::asio::io_context& io, std::function<void()> stop) : signals_(io, SIGINT, SIGTERM) {
  struct sigaction hang_up {};
  if (::sigaction(SIGHUP, nullptr, &hang_up) == 0 && hang_up.sa_handler != SIG_IGN) signals_.add(SIGHUP);
  signals_.async_wait([this, stop = std::move(stop)](const boost::system::error_code& error, int) {
    if (error) return;
    signals_.clear();
    stop();
  });
}

}  // namespace weir
