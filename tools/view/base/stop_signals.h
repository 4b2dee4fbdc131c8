// The signals that end a server, of which a second one ends it at once.
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/signal_set.hpp>
#include <functional>

namespace weir {

class StopSignals {
 public:
  /// Calls `stop` on the io_context's thread at the first SIGINT, SIGTERM or, but under nohup, SIGHUP. From then on
  /// they have their default effect: what `stop` waits for, as a volume that is being loaded, may take long.
  StopSignals(boost::asio::io_context& io, std::function<void()> stop);

 private:
  boost::asio::signal_set signals_;
};

}  // namespace weir
