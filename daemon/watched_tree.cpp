#include "daemon/watched_tree.h"
#include "daemon/config/config_names.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "daemon/jobs/conversion_task.h"
#include "daemon/watch/choosing_watch.h"
#include "daemon/watch/repeated_events.h"
#include "format/base/error.h"
#include "format/io/is_directory.h"

namespace weir {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

/// Delay before the state file is tried again.
constexpr milliseconds kRetry{1000};
/// Least time between two records of a file that is being written to.
constexpr std::chrono::seconds kBetweenRecords{5};
/// Delay before an unreachable file is looked at again.
constexpr std::chrono::seconds kUnreachable{5};
/// A transaction handles as many events and looks as fit in this time, for few disk flushes and quick answers to
/// others.
constexpr milliseconds kTransactionTime{8};
constexpr std::size_t kLeastBatch = 20;
constexpr std::size_t kMostBatch = 100;  // the next looks may take longer than the last ones

// Returns whether `path` is valid UTF-8. The API, the page and convert's announcements carry only text.
bool is_text(const std::string& path) {
  try {
    static_cast<void>(nlohmann::json(path).dump());
    return true;
  } catch (const nlohmann::json::type_error&) {
    return false;
  }
}

// Delay before the next check whether a running job, to whose source a program has written, is over.
constexpr std::chrono::seconds kAfterRun{1};

// Returns whether the source may have kept its time although it was rewritten after its conversion began. File
// systems count time in ticks of a few milliseconds, some in seconds, FAT in two seconds. Git calls such a time
// "racy".
bool may_hide_a_write(const Job& job) {
  const bool coarse = job.identity.mtime_ns % 1'000'000'000 == 0;
  return job.started_ms <= job.identity.mtime_ns / 1'000'000 + (coarse ? 2000 : 20);
}

}  // namespace

WatchedTree::WatchedTree(boost::asio::io_context& io, DiskTurns& turns, WatchConfig config, JobStore& store,
                         const EventLog& log, Reports reports)
    : config_(std::move(config)),
      options_(options_text(config_)),
      turns_(turns),
      store_(store),
      log_(log),
      reports_(std::move(reports)),
      stores_(io, config_,
              [this](const std::string& head) {
                if (!tracked_.contains(head)) take({FileEventKind::found, head});  // otherwise it is looked at anyway
              }),
      timer_(io) {
  watch_ = make_directory_watch(io, config_,
                                {[this](const FileEvent& event) { take(event); },
                                 [this](const std::string& line) {
                                   log_.warn("watch", {{"watch", config_.label}, {"notice", line}});
                                 }});
  if (const std::string unused = config_.unused_key(); !unused.empty()) {
    log_.warn("watch", {{"watch", config_.label}, {"notice", unused}});
  }
  schedule(milliseconds(0));
}

WatchedTree::Status WatchedTree::status() const {
  const std::string reason = !watch_->up() ? config_.directory + " is not there" : store_fault_;
  return {std::string(watch_method_name(watch_->method())), reason.empty(), reason, watch_->figures().overflows};
}

void WatchedTree::look_again(const std::string& path) {
  again_.insert(path);
  take({FileEventKind::found, path});
}

std::string WatchedTree::waits_for(const std::string& path) const {
  const auto at = tracked_.find(path);
  return at == tracked_.end() ? "" : at->second.waits_for;
}

void WatchedTree::take(const FileEvent& event) {
  events_.push_back(event);
  if (!watch_->figures().looked) first_events_ = events_.size();
  if (events_.size() >= repeats_dropped_at_) {
    first_events_ = drop_repeated_events(events_, first_events_);
    repeats_dropped_at_ = std::max(kManyEvents, 2 * events_.size());
  }
  if (store_fault_.empty()) schedule(milliseconds(0));  // otherwise the next try is scheduled already
}

void WatchedTree::schedule(milliseconds delay) {
  if (scheduled_ && timer_.expiry() <= Clock::now() + delay) return;
  scheduled_ = true;
  timer_.expires_after(delay);
  timer_.async_wait([this, alive = std::weak_ptr(alive_)](boost::system::error_code error) {
    if (error || alive.expired()) return;
    turns_.take([this, alive] {
      if (!alive.expired()) work();
    });
  });
}

// Handles all events and looks that are due, in a transaction. If the state file cannot be written, nothing has
// changed and all is due again.
void WatchedTree::work() {
  scheduled_ = false;
  looked_at_.clear();
  const auto count =
      static_cast<std::ptrdiff_t>(std::min(events_.size(), batch_ / 2));  // the rest is for looks of the agenda
  Clock::duration looking{};  // without the flush, whose time hardly depends on the number of looks
  const std::vector<FileEvent> events(events_.begin(), events_.begin() + count);
  const std::size_t first = std::min(events.size(), first_events_);
  const KnownJobs::Progress known = known_.progress();
  try {
    store_.together([&] {
      known_.step(kTransactionTime);
      const Time begin = Clock::now();
      work_off(events, first);
      looking = Clock::now() - begin;
    });
    store_fault_.clear();
  } catch (const CorruptDatabase&) {
    throw;
  } catch (const Error& error) {
    if (store_fault_.empty()) log_.error("state-file-fault", {{"watch", config_.label}, {"reason", error.what()}});
    store_fault_ = error.what();
    written_.clear();
    ready_ = false;
    superseded_.clear();
    known_.go_back_to(known);
    // Paths that were looked at are due again; those no longer tracked come again as found. The events are in events_.
    for (const FileEvent& event : events) looked_at_.erase(event.path);
    for (const std::string& path : looked_at_) {
      if (tracked_.contains(path)) {
        track_until(path, Clock::now());
      } else {
        events_.push_back({FileEventKind::found, path});
      }
    }
    schedule(kRetry);
    return;
  }
  events_.erase(events_.begin(), events_.begin() + count);
  first_events_ -= first;
  fit_batch(looking);
  log_look(events.size());
  for (const auto& say : std::exchange(written_, {})) say();
  for (const std::int64_t job : std::exchange(superseded_, {})) reports_.superseded(job);
  if (std::exchange(ready_, false)) reports_.ready();
  if (!events_.empty() || !known_.over()) {
    schedule(milliseconds(0));
  } else if (!agenda_.empty()) {
    schedule(std::max(milliseconds(0), std::chrono::ceil<milliseconds>(agenda_.begin()->first - Clock::now())));
  }
}

void WatchedTree::log_look(std::size_t events) const {
  if (events == 0 && looked_at_.empty()) return;
  const WatchFigures figures = watch_->figures();
  log_.debug("look", {{"watch", config_.label},
                      {"events", events},
                      {"looked_at", looked_at_.size()},
                      {"waiting", tracked_.size()},
                      {"directories", figures.directories},
                      {"files", figures.files}});
}

void WatchedTree::fit_batch(Clock::duration looking) {
  const std::size_t looked = looked_at_.size();
  if (looked == 0 || (looking < kTransactionTime && looked < batch_ / 2))
    return;  // too little work to estimate how much fits
  const double fit = static_cast<double>(looked) * (std::chrono::duration<double>(kTransactionTime) / looking);
  batch_ = static_cast<std::size_t>(std::clamp(fit, double{kLeastBatch}, double{kMostBatch}));
}

void WatchedTree::work_off(const std::vector<FileEvent>& events, std::size_t first) {
  const Time now = Clock::now();
  std::set<std::string>& changed = looked_at_;
  changed.clear();
  for (std::size_t i = 0; i < events.size(); ++i) {
    const FileEvent& event = events[i];
    switch (event.kind) {
      case FileEventKind::overflow:
        // The close event that a file waits for may be among the lost events.
        for (auto& [path, tracked] : tracked_) {
          tracked.completion.happened(FileEventKind::overflow, now);
          track_until(path, now);
        }
        break;
      case FileEventKind::root_lost:
      case FileEventKind::root_back:
        if (event.kind == FileEventKind::root_back) known_.begin_anew();
        ready_ = ready_ || event.kind == FileEventKind::root_back;  // jobs waited for the directory
        log_.warn(
            "watch",
            {{"watch", config_.label},
             {"notice", config_.directory +
                            (event.kind == FileEventKind::root_lost ? " is not there; waiting for it" : " is there")}});
        break;
      default: {
        auto at = tracked_.find(event.path);
        if (at == tracked_.end()) {
          at =
              tracked_.emplace(event.path, Tracked{FileCompletion(completion_rules(config_, event.path, store_turns_))})
                  .first;
        }
        Tracked& tracked = at->second;
        tracked.completion.happened(event.kind, now);
        const bool again = again_.erase(event.path) > 0;
        tracked.arrived = tracked.arrived || (i >= first && !again);
        tracked.permitted = tracked.permitted || event.kind == FileEventKind::permitted;
        tracked.written = tracked.written || event.kind == FileEventKind::written ||
                          event.kind == FileEventKind::closed || event.kind == FileEventKind::moved_in;
        changed.insert(event.path);
        break;
      }
    }
  }
  while (!agenda_.empty() && agenda_.begin()->first <= now && changed.size() < batch_) {
    changed.insert(agenda_.begin()->second);
    agenda_.erase(agenda_.begin());
  }
  for (const std::string& path : changed) look(path, now);
}

void WatchedTree::look(const std::string& path, Time now) {
  FileSample sample;
  try {
    sample = sample_file(path, config_.complete == Completion::marker ? config_.marker : "", config_.convert_options);
  } catch (const Error& error) {  // a fault of this file alone; the others go on
    if (!std::exchange(tracked_.at(path).unreachable, true)) {
      log_.warn("watch", {{"watch", config_.label}, {"notice", error.what()}});
    }
    tracked_.at(path).waits_for = error.what();
    track_until(path, now + kUnreachable);
    return;
  }
  if (!sample.exists) {
    gone(path);
    return;
  }
  if (is_store_head(path)) stores_.seen(path, sample.identity);
  if (keeps_growing(path, sample, now)) return;
  const JobStore::Observation seen = store_.observe(config_.label, path, sample.identity, options_);
  if (seen.change == JobStore::Change::created) {
    written_.emplace_back([this, path, id = seen.job.id, bytes = sample.identity.bytes] {
      log_.info("discovered", {{"job", id}, {"source", path}, {"bytes", bytes}});
    });
  } else if (seen.change ==
             JobStore::Change::changed) {  // the job may be running, or its thumbnails are being rendered
    superseded_.push_back(seen.job.id);
    tracked_.at(path).completion.source_before();
  }
  if (seen.job.state == JobState::running && tracked_.at(path).written && may_hide_a_write(seen.job)) {
    track_until(path, now + kAfterRun);
    return;
  }
  const bool again = tries_again(path, seen.job);
  if (again && seen.job.state == JobState::waiting) ready_ = true;
  if (seen.job.state == JobState::waiting || (seen.job.state != JobState::discovered && !again)) {
    forget(path);  // known and unchanged
    return;
  }
  if (!is_text(path)) {
    quarantine(path, seen.job.id, "the name is not UTF-8; rename the file");
    return;
  }
  tracked_.at(path).recorded = now;
  apply(path, tracked_.at(path).completion.look(sample, now), seen.job);
}

// Returns whether the state file need not hear of the file yet. A file that is being written to may change fifty
// times a second, and each write to the state file flushes a disk. So a growing file is recorded only every few
// seconds.
bool WatchedTree::keeps_growing(const std::string& path, const FileSample& sample, Time now) {
  Tracked& tracked = tracked_.at(path);
  if (is_store_head(path) || !tracked.recorded || now - *tracked.recorded >= kBetweenRecords) return false;
  const CompletionAnswer answer = tracked.completion.look(sample, now);
  if (answer.state != CompletionAnswer::State::waiting) return false;
  tracked.waits_for = answer.reason;
  track_until(path, std::min(answer.until, *tracked.recorded + kBetweenRecords));
  return true;
}

// Lets a known job with an unchanged source run once more if there is a reason. Returns whether it does.
bool WatchedTree::tries_again(const std::string& path, const Job& job) {
  Tracked& tracked = tracked_.at(path);
  const bool permitted = std::exchange(tracked.permitted, false);
  if (job.state == JobState::done) return tracked.written && may_hide_a_write(job) && store_.retry(job.id);
  return permitted && store_.hasten(job.id);
}

void WatchedTree::apply(const std::string& path, const CompletionAnswer& answer, const Job& job) {
  switch (answer.state) {
    case CompletionAnswer::State::complete:
      store_.enqueue(job.id);
      if (tracked_.at(path).arrived) {
        written_.emplace_back([this, bytes = job.identity.bytes] { arrivals_.add(bytes, Clock::now()); });
      }
      ready_ = true;
      forget(path);
      break;
    case CompletionAnswer::State::waiting:
      tracked_.at(path).waits_for = answer.reason;
      track_until(path, answer.until);
      break;
    case CompletionAnswer::State::broken:
      quarantine(path, job.id, answer.reason);
      break;
    case CompletionAnswer::State::gone:
      gone(path);
      break;
  }
}

void WatchedTree::track_until(const std::string& path, Time until) {
  Tracked& tracked = tracked_.at(path);
  agenda_.erase({tracked.look, path});
  tracked.look = until;
  if (until != Time::max()) agenda_.insert({until, path});
}

void WatchedTree::has_turn(const std::string& head) {
  if (!tracked_.contains(head)) return;
  track_until(head, Clock::now());
  if (store_fault_.empty()) schedule(milliseconds(0));
}

void WatchedTree::forget(const std::string& path) {
  const auto at = tracked_.find(path);
  if (at == tracked_.end()) return;
  agenda_.erase({at->second.look, path});
  const auto ended = tracked_.extract(at);  // its destruction may give a turn to another hierarchy
}

void WatchedTree::gone(const std::string& path) {
  stores_.forget(path);
  forget(path);
  const auto job = store_.find(config_.label, path);
  // A done job stays as the record of its result, and a cancelled one as that of a decision. A running job notices
  // the loss itself.
  if (!job || std::ranges::find(kForgottenStates, job->state) == kForgottenStates.end()) return;
  if (!is_directory(config_.directory)) return;  // when it is back, the file is found again or its job is forgotten
  store_.remove(job->id);
  written_.emplace_back([this, path, id = job->id] { log_.info("source-gone", {{"job", id}, {"source", path}}); });
}

void WatchedTree::quarantine(const std::string& path, std::int64_t job, const std::string& reason) {
  store_.quarantine(job, reason);
  written_.emplace_back([this, path, job, reason] {
    log_.warn("quarantined", {{"job", job}, {"source", path}, {"reason", reason}});
  });
  forget(path);
}

}  // namespace weir
