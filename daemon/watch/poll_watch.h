// Watching by polling: where other machines make changes, and where inotify's limits are reached.
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
  /// Begins a look WatchConfig::poll_interval_s after the end of the one before. `table` must outlive the object.
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
  std::uint64_t directories_ = 0;  ///< in the last look that ended
  std::uint64_t entered_ = 0;      ///< in this one
  boost::asio::steady_timer timer_;
  std::shared_ptr<void> alive_ = std::make_shared<char>();  ///< a handler may be on its way when the watch ends
};

}  // namespace weir
