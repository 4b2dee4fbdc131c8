// Runs work that waits for the state file's disk on the event loop, one piece at a time. A request that comes in
// between is answered after one piece, not after all queued pieces. Lives on the io_context's thread.
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <deque>
#include <functional>

namespace weir {

class DiskTurns {
 public:
  explicit DiskTurns(boost::asio::io_context& io) : timer_(io) {}

  /// Calls `work` after the pieces queued before. Each runs in a handler of its own, 1 ms after the one before, so
  /// that requests are answered in between. An exception of `work` leaves the event loop, and no further piece runs.
  void take(std::function<void()> work);

 private:
  void await_next();
  void run_next();

  boost::asio::steady_timer timer_;
  std::deque<std::function<void()>> queue_;
  /// The next piece does not run before this time.
  boost::asio::steady_timer::time_point next_ = boost::asio::steady_timer::clock_type::now();
};

}  // namespace weir
