// Watching by inotify. These rules make sure that no change is lost:
//   1. A directory is watched first and listed afterwards: an entry made before the watch is in the list, an entry
//      made after it is an event. This holds for the first look and for each directory made or moved in later.
//   2. When events are lost (the queue overflowed), everything begins anew: a new queue, new watches, a full look.
//   3. The directory itself is looked at every second, because inotify reports no event when its parents are renamed,
//      mounted over or replaced.
//   4. A full look is made every five minutes for changes that inotify does not report: a mount below the directory,
//      or a changed target of a link.
//
// States and their transitions:
//
//   state      the queue  what it means
//   absent     closed     the directory is not there
//   scanning   open       the whole tree is being listed
//   watching   open       all that is there is known, events tell of the rest
//   lost       open       events were lost; a moment later all begins anew
//   failed     closed     inotify cannot do it, which is reported once; nothing follows
//
//   from                to        when
//   any but failed      scanning  the directory is there and was not, or is another one: with a new queue
//   any but failed      absent    the directory is missing
//   scanning            watching  the listing has ended
//   watching            scanning  every five minutes, or the root's watch is gone: with the same queue
//   scanning, watching  lost      the queue overflowed, or a mount below ended
//   lost                scanning  0.1 s later, with a new queue
//   any but absent      failed    a watch or a queue is refused, or the queue fails
//
// Besides, while the queue is open, single directories and files that events name are looked at (TreeLook).
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
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

  /// `give_up` is called from a handler when inotify cannot do the work. Afterwards nothing is reported, and the
  /// owner may destroy the watch once `give_up` has returned. `table` must outlive the object.
  InotifyWatch(boost::asio::io_context& io, SourceTable& table, OpenInotify open, GiveUp give_up);
  ~InotifyWatch() override;

  WatchMethod method() const override { return WatchMethod::inotify; }
  bool up() const override { return table_.up(); }
  WatchFigures figures() const override {
    return {table_.overflows(), watches_.size(), table_.size(), table_.looked()};
  }

 private:
  using Change = std::pair<FileEventKind, std::string>;

  enum class State { absent, scanning, watching, lost, failed };

  bool is_open() const { return state_ == State::scanning || state_ == State::watching || state_ == State::lost; }
  void start();
  void close(State next);
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
  State state_ = State::absent;
  std::string failure_;  ///< why it failed
  std::unique_ptr<Inotify> inotify_;
  boost::asio::posix::stream_descriptor stream_;
  std::unordered_map<int, std::string> directories_;  ///< relative paths by watch number
  std::map<std::string, int> watches_;                ///< watch numbers by directory
  std::vector<Change> changes_;                       ///< changes of this batch, to be delivered
  TreeLook look_;
  bool looking_ = false;         ///< look_timer_ waits for the next step of look_
  bool looking_at_all_ = false;  ///< the whole tree is part of the present look
  std::chrono::steady_clock::time_point looked_at_all_{};
  boost::asio::steady_timer root_timer_;
  boost::asio::steady_timer look_timer_;
  boost::asio::steady_timer batch_timer_;
  std::shared_ptr<void> alive_ = std::make_shared<char>();  ///< a queued handler may outlive the object
};

}  // namespace weir
