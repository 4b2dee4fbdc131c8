// Runs work that waits for the state file's disk on the event loop, one piece at a time: a request that comes meanwhile
// is answered after one piece, not after all that are queued. Lives on the io_context's thread.
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <deque>
#include <functional>

namespace weir {

class DiskTurns {
 public:
  explicit DiskTurns(boost::asio::io_context& io) : timer_(io) {}

  /// Calls `work` after those that are queued, each in a handler of its own and 1 ms after the one before, in which
  /// what came meanwhile is answered. What it throws leaves the event loop, and nothing else has a turn.
  void take(std::function<void()> work);

 private:
  void await_next();
  void run_next();

  boost::asio::steady_timer timer_;
  std::deque<std::function<void()>> queue_;
  boost::asio::steady_timer::time_point next_ = boost::asio::steady_timer::clock_type::now();  ///< not before this time
};

}  // namespace weir
