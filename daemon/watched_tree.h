// One [[watch]] at work. Events of its files become jobs in the state file. A job becomes "waiting" when its file is
// complete. One thread: the io_context's.
//
// Events are collected and written in one transaction, so that two thousand files that appear at once cost a few disk
// flushes instead of two thousand.
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "daemon/config/config.h"
#include "daemon/disks/recent_rate.h"
#include "daemon/known_jobs.h"
#include "daemon/log/event_log.h"
#include "daemon/store/disk_turns.h"
#include "daemon/store/job_store.h"
#include "daemon/watch/completion.h"
#include "daemon/watch/directory_watch.h"
#include "daemon/watch/store_poll.h"

namespace weir {

class WatchedTree {
 public:
  struct Reports {
    std::function<void()> ready;                       ///< a job is waiting that was not waiting before
    std::function<void(std::int64_t job)> superseded;  ///< the source of a running job was rewritten
  };

  /// `turns`, `store` and `log` must outlive the tree. Reports are called from handlers of `io` only.
  WatchedTree(boost::asio::io_context& io, DiskTurns& turns, WatchConfig config, JobStore& store, const EventLog& log,
              Reports reports);

  const WatchConfig& config() const { return config_; }
  struct Status {
    std::string method;  ///< "inotify" or "poll"
    bool up = false;
    std::string reason;  ///< why the watch is not up: the directory is missing, or the state file cannot be written
    std::uint64_t overflows = 0;
  };
  Status status() const;

  /// Returns in words what the file at `path` still waits for before it is taken; empty if the tree does not wait for
  /// it.
  std::string waits_for(const std::string& path) const;
  /// Returns the rates, over the last ten minutes, of the sources that came since the first look at the directory.
  RecentRate::Rates arrivals() const { return arrivals_.at(std::chrono::steady_clock::now()); }

  /// Treats the file at `path` as just found, because a retry of its job was requested or its content has changed.
  void look_again(const std::string& path);
  /// Must be called when the service reads its configuration again and this watch stays as it is.
  void reloaded() { watch_->choose_again(); }

 private:
  using Time = std::chrono::steady_clock::time_point;
  static constexpr std::chrono::seconds kArrivalWindow{600};
  static constexpr std::size_t kStoresAtOnce = 2;
  static constexpr std::size_t kManyEvents = 10'000;
  struct Tracked {
    FileCompletion completion;
    Time look = Time::max();
    std::string waits_for{};         ///< why it was not complete at the last look
    bool arrived = false;            ///< the file came, or was written to, since the first look at the directory
    bool written = false;            ///< a program was seen to write to it
    bool permitted = false;          ///< the file's mode or owner was set
    bool unreachable = false;        ///< the file could not be looked at, and the log says so
    std::optional<Time> recorded{};  ///< when the state file last recorded the file as an incomplete source
  };

  void take(const FileEvent& event);
  void schedule(std::chrono::milliseconds delay);
  void work();
  /// The first `first` of `events` come from the first look at the directory.
  void work_off(const std::vector<FileEvent>& events, std::size_t first);
  void look(const std::string& path, Time now);
  bool keeps_growing(const std::string& path, const FileSample& sample, Time now);
  void log_look(std::size_t events) const;
  void fit_batch(std::chrono::steady_clock::duration looking);
  bool tries_again(const std::string& path, const Job& job);
  void apply(const std::string& path, const CompletionAnswer& answer, const Job& job);
  void track_until(const std::string& path, Time until);
  void has_turn(const std::string& head);
  void forget(const std::string& path);
  void gone(const std::string& path);
  void quarantine(const std::string& path, std::int64_t job, const std::string& reason);

  WatchConfig config_;
  std::string options_;
  DiskTurns& turns_;
  JobStore& store_;
  const EventLog& log_;
  Reports reports_;
  std::map<std::string, Tracked> tracked_;         ///< files that are not known to be complete
  std::set<std::pair<Time, std::string>> agenda_;  ///< when to look at each tracked file
  std::deque<FileEvent> events_;
  std::set<std::string> again_;   ///< paths in events_ that look_again() added: they are not arrivals
  std::size_t first_events_ = 0;  ///< this many of events_ come from the first look at the directory
  RecentRate arrivals_{kArrivalWindow, std::chrono::steady_clock::now()};
  std::set<std::string> looked_at_;               ///< paths that the last transaction looked at
  std::size_t batch_ = 100;                       ///< upper limit of events and looks in the next transaction
  std::size_t repeats_dropped_at_ = kManyEvents;  ///< when events_ has this size, repeated events are dropped
  KnownJobs known_{config_, store_};
  std::string store_fault_;  ///< why the state file cannot be written; empty if it can
  bool scheduled_ = false;
  /// What the current transaction leaves to do once it is written: log lines and counts, whether a job is ready, and
  /// which jobs are superseded.
  std::vector<std::function<void()>> written_;
  bool ready_ = false;
  std::vector<std::int64_t> superseded_;
  /// Declared after tracked_, so that this object is destroyed first: tracked files that end afterwards give no turns
  /// to others.
  std::shared_ptr<StoreTurns> store_turns_ =
      std::make_shared<StoreTurns>(kStoresAtOnce, [this](const std::string& head) { has_turn(head); });
  StorePoll stores_;
  boost::asio::steady_timer timer_;
  std::unique_ptr<DirectoryWatch> watch_;
  std::shared_ptr<void> alive_ = std::make_shared<char>();  ///< a queued handler may outlive the object
};

}  // namespace weir
