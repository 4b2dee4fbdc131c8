// Watching by polling, for file systems that other machines change and for when inotify's limits are reached.
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <memory>

#include "daemon/watch/directory_watch.h"
#include "daemon/watch/source_table.h"
#include "daemon/watch/tree_look.h"

namespace weir {

class PollWatch final : public DirectoryWatch {
 public:
  /// Begins each look WatchConfig::poll_interval_s after the end of the look before. `table` must outlive the object.
  PollWatch(boost::asio::io_context& io, SourceTable& table);

  WatchMethod method() const override { return WatchMethod::poll; }
  bool up() const override { return table_.up(); }
  WatchFigures figures() const override { return {table_.overflows(), directories_, table_.size(), table_.looked()}; }

 private:
  void begin();
  void step();
  void wait(std::chrono::duration<double> delay, void (PollWatch::*next)());

  SourceTable& table_;
  TreeLook look_;
  std::uint64_t directories_ = 0;  ///< number of directories in the last complete look
  std::uint64_t entered_ = 0;      ///< number of directories entered so far in this look
  boost::asio::steady_timer timer_;
  std::shared_ptr<void> alive_ = std::make_shared<char>();  ///< a queued handler may outlive the object
};

}  // namespace weir
