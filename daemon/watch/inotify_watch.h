// Watching by inotify. What makes it lose nothing:
//   1. A directory is watched first and listed then: what comes before the watch is in the list, what comes
//      after it is an event. So for the first look, and for each directory that is made or moved in later.
//   2. Where events were lost (the queue overflowed) all begins anew: a new queue, new watches, a look at everything.
//   3. The directory itself is looked at every second: its being renamed, mounted over or replaced along with
//      its parents is no event of its own.
//   4. Every five minutes everything is looked at all the same, for what inotify does not tell: a
//      mount below the directory, the target of a link that changed.
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "daemon/watch/directory_watch.h"
#include "daemon/watch/inotify.h"
#include "daemon/watch/source_table.h"
#include "daemon/watch/tree_look.h"

struct inotify_event;

namespace weir {

class InotifyWatch final : public DirectoryWatch {
 public:
  using GiveUp = std::function<void(const std::string& reason)>;

  /// `give_up` is called, from a handler, when inotify cannot do it; then nothing is reported any more, and the
  /// callee may destroy the watch once it returned. `table` must outlive the object.
  InotifyWatch(boost::asio::io_context& io, SourceTable& table, OpenInotify open, GiveUp give_up);
  ~InotifyWatch() override;

  WatchMethod method() const override { return WatchMethod::inotify; }
  bool up() const override { return table_.up(); }
  WatchFigures figures() const override {
    return {table_.overflows(), watches_.size(), table_.size(), table_.looked()};
  }

 private:
  using Change = std::pair<FileEventKind, std::string>;

  void start();
  void stop();
  void fail(std::string reason);
  void report_failure();
  void look_at_root();
  bool look_is_due() const;
  void look_at_all(bool events_tell);
  void look_on();
  void step();
  void enter(const std::string& directory);
  void leave(const std::string& directory);
  void await_events();
  void read_events();
  void take(const inotify_event& event, std::string_view name);
  void take_directory(std::uint32_t mask, const std::string& path);
  void take_file(std::uint32_t mask, const std::string& path);
  void deliver();
  void after(boost::asio::steady_timer& timer, std::chrono::milliseconds delay, void (InotifyWatch::*next)());

  SourceTable& table_;
  OpenInotify open_;
  GiveUp give_up_;
  std::string failure_;  ///< empty: none
  std::unique_ptr<Inotify> inotify_;
  boost::asio::posix::stream_descriptor stream_;
  std::unordered_map<int, std::string> directories_;  ///< by watch; relative paths
  std::map<std::string, int> watches_;                ///< by directory
  std::vector<Change> changes_;                       ///< of this batch, to be delivered
  bool begin_anew_ = false;                           ///< events were lost
  TreeLook look_;
  bool looking_ = false;
  bool looking_at_all_ = false;
  std::chrono::steady_clock::time_point looked_at_all_{};
  boost::asio::steady_timer root_timer_;
  boost::asio::steady_timer look_timer_;
  boost::asio::steady_timer batch_timer_;
  std::shared_ptr<void> alive_ = std::make_shared<char>();  ///< a handler may be on its way when the watch ends
};

}  // namespace weir
