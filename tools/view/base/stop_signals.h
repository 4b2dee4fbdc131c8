// The signals that end a server. A second signal ends it at once.
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/signal_set.hpp>
#include <functional>

namespace weir {

class StopSignals {
 public:
  /// Calls `stop` on the io_context's thread at the first SIGINT, SIGTERM or SIGHUP (SIGHUP not under nohup). After
  /// that the signals have their default effect, because `stop` may have to wait long, for instance for a volume that
  /// is being loaded.
  StopSignals(boost::asio::io_context& io, std::function<void()> stop);

 private:
  boost::asio::signal_set signals_;
};

}  // namespace weir
