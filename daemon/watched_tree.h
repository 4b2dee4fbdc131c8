// One [[watch]] at work: what happens to its files becomes jobs in the state
// file, and a job whose file is complete waits to be converted. One thread, that
// of the io_context.
//
// Events are taken together and written in one transaction, so that two thousand
// files that appear at once cost a few flushes of the disk and not two thousand.
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
    std::function<void()> ready;                       ///< a job waits that did not before
    std::function<void(std::int64_t job)> superseded;  ///< the source of a running job was rewritten
  };

  /// `turns`, `store` and `log` must outlive the tree. Reports are called from handlers of `io` only.
  WatchedTree(boost::asio::io_context& io, DiskTurns& turns, WatchConfig config, JobStore& store, const EventLog& log,
              Reports reports);

  const WatchConfig& config() const { return config_; }
  struct Status {
    std::string method;  ///< "inotify" or "poll"
    bool up = false;
    std::string reason;  ///< why not: the directory is not there, or the state file cannot be written
    std::uint64_t overflows = 0;
  };
  Status status() const;

  /// What the file at `path` still waits for before it is taken, in words; empty: it is not waited for.
  std::string waits_for(const std::string& path) const;
  /// Of the sources that came since the first look at the directory, over the last ten minutes.
  RecentRate::Rates arrivals() const { return arrivals_.at(std::chrono::steady_clock::now()); }

  /// Takes the file as just found: a retry of its job was requested, or its content has changed.
  void look_again(const std::string& path);
  /// The service was told to read its configuration again, and this watch stays as it is.
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
    bool arrived = false;            ///< it came, or was written to, since the first look at the directory
    bool written = false;            ///< a program was seen to write to it
    bool permitted = false;          ///< its mode or owner was set
    bool unreachable = false;        ///< it could not be looked at, which was said
    std::optional<Time> recorded{};  ///< when the state file last heard of it, as a source that is not complete
  };

  void take(const FileEvent& event);
  void schedule(std::chrono::milliseconds delay);
  void work();
  /// The first `first` of `events` are of the first look at the directory.
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
  std::set<std::pair<Time, std::string>> agenda_;  ///< when to look at which of them
  std::deque<FileEvent> events_;
  std::set<std::string> again_;   ///< of events_, those of look_again: nothing arrived
  std::size_t first_events_ = 0;  ///< so many of events_ are of the first look at the directory
  RecentRate arrivals_{kArrivalWindow, std::chrono::steady_clock::now()};
  std::set<std::string> looked_at_;               ///< paths, in the last transaction
  std::size_t batch_ = 100;                       ///< events and looks in the next one, at most
  std::size_t repeats_dropped_at_ = kManyEvents;  ///< so many events are gone through for equal ones
  KnownJobs known_{config_, store_};
  std::string store_fault_;  ///< why what was seen cannot be written down; empty: it can
  bool scheduled_ = false;
  /// For after the transaction: what is logged and counted of it, whether a job is ready, which are superseded.
  std::vector<std::function<void()>> written_;
  bool ready_ = false;
  std::vector<std::int64_t> superseded_;
  /// Not outlived by what is tracked, whose ends would give turns to others.
  std::shared_ptr<StoreTurns> store_turns_ =
      std::make_shared<StoreTurns>(kStoresAtOnce, [this](const std::string& head) { has_turn(head); });
  StorePoll stores_;
  boost::asio::steady_timer timer_;
  std::unique_ptr<DirectoryWatch> watch_;
  std::shared_ptr<void> alive_ = std::make_shared<char>();  ///< a wait that has ended may be called yet
};

}  // namespace weir
