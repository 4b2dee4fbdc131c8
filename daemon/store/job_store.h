// Every job there is, in one SQLite file that outlives the daemon: a kill -9 or
// a power failure between any two statements loses no job, a call that returned
// is on disk. One thread; one process, which keeps the file locked while the
// store lives.
//
//   discovered --enqueue--> waiting --start--> running --finish--> done
//        ^                    ^  ^                |--fail--> waiting (later), failed, quarantined
//        |                    |  |---postpone-----|
//   observe (changed)       open (was running)
//   retry (what is over)                           cancel: discovered, waiting, running --> cancelled
//
// Every step names the state it starts from and answers false where the job is in
// another one (or gone), so that a late report of a job that was cancelled, or
// whose source was rewritten meanwhile, changes nothing.
//
// All functions throw Error(io) where the file cannot be read or written (disk
// full among them); the store stays usable and unchanged, and the call may be repeated.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "daemon/config/priority.h"
#include "daemon/store/job.h"
#include "daemon/store/job_order.h"
#include "daemon/store/sqlite.h"

namespace weir {

/// Delay before the next attempt after `attempts` failed ones: 5 s, doubling, 10 min at most.
std::int64_t backoff_ms(int attempts);
inline constexpr int kMaxAttempts = 5;

/// Which jobs to list; empty: any.
struct JobFilter {
  std::optional<JobState> state;
  std::string watch;
  std::string text{};     ///< a part of the source's path or of the reason, letter case aside where it is ASCII
  std::string problem{};  ///< of failed and quarantined ones: JobProblem::key
};

/// Failed and quarantined jobs of equal reasons (problem_key.h).
struct JobProblem {
  std::string key;
  std::uint64_t count = 0;
  Job newest;
};

using JobCounts = std::array<std::uint64_t, kJobStates>;  ///< indexed by JobState

class JobStore {
 public:
  /// Milliseconds since the epoch.
  using Clock = std::function<std::int64_t()>;
  static std::int64_t wall_clock_ms();

  /// Opens `path`, made if missing. Jobs that were running are waiting again, at no cost. A corrupt file is moved
  /// aside to PATH.corrupt-N and an empty one made. Throws Error(input) for a database of a newer weir or of
  /// another program, Error(io) where it cannot be opened or another process has it open.
  explicit JobStore(const std::string& path, Clock clock = wall_clock_ms);

  /// What opening had to say for the log, one line; empty: nothing.
  const std::string& notice() const { return notice_; }

  /// Runs `steps` as one transaction: all of them or, where one throws, none are kept. A thousand calls so
  /// grouped cost one fsync. May be nested.
  void together(const std::function<void()>& steps);

  /// Whether so much was written since the last checkpoint() that one is due.
  bool checkpoint_due() const;
  /// Moves what was written from the journal into the file: two flushes of the disk, which else a write would have to
  /// wait for.
  void checkpoint() { database_.checkpoint(); }

  enum class Change { none, created, changed };
  struct Observation {
    Change change;
    std::optional<JobState> before;  ///< absent where it was created
    Job job;                         ///< as it is now
  };
  /// The source was seen with that identity. A job whose identity or `options` changed (any text that says how
  /// it is converted) is discovered again, from any state, with its attempts and result forgotten. Each change is
  /// a write to disk: for a file that is still growing, observe its beginning and its end.
  Observation observe(const std::string& watch, const std::string& source, const FileIdentity& identity,
                      const std::string& options);

  bool enqueue(std::int64_t id);                          ///< discovered -> waiting
  bool start(std::int64_t id);                            ///< waiting -> running
  bool finish(std::int64_t id, const JobResult& result);  ///< running -> done
  /// running -> quarantined for exit code 3; failed for 2 and 4, which another attempt cannot change; else
  /// waiting for backoff_ms, and failed at the kMaxAttempts-th time.
  bool fail(std::int64_t id, const JobResult& result);
  /// running -> waiting with `reason`, for `delay_ms` at least, and nothing counted: the disk is full, the source is
  /// being written to, or the service goes down.
  bool postpone(std::int64_t id, const std::string& reason, std::int64_t delay_ms = 0);
  /// discovered, waiting or running -> quarantined: the source can never be complete.
  bool quarantine(std::int64_t id, const std::string& reason);
  bool cancel(std::int64_t id);  ///< discovered, waiting or running -> cancelled
  /// done, failed, quarantined or cancelled -> discovered, as if just seen; waiting after a failure -> due at once.
  /// Either way no attempt counts any more.
  /// `force`: and it is converted even where its outputs are done.
  bool retry(std::int64_t id, bool force = false);
  /// retry() where the job is failed or quarantined.
  bool retry_problem(std::int64_t id);
  /// One attempt at once, which counts as any other, of a job that failed or waits after exit code 5.
  bool hasten(std::int64_t id);
  /// retry() of all that failed by exit code 5: at a start of the service the device or the rights may be other ones.
  void retry_failed_io();
  bool remove(std::int64_t id);  ///< forgets a job, running ones excepted (its source is gone)
  /// A watch as it is now: jobs of its label whose sources lie elsewhere are of one that it was before.
  struct Watched {
    std::string label;
    std::string directory;  ///< as in WatchConfig
  };
  /// Forgets the jobs of all watches but these: what is not over, and what failed. Running ones, results and what was
  /// cancelled stay.
  void forget_other_watches(const std::vector<Watched>& watches);

  std::optional<Job> job(std::int64_t id) const;
  std::optional<Job> find(const std::string& watch, const std::string& source) const;
  /// In the order of `order`; where none is given, last changed first, and where only waiting ones are asked for, the
  /// one longest in the queue first.
  std::vector<Job> jobs(const JobFilter& filter, std::size_t offset, std::size_t limit,
                        const std::optional<JobOrder>& order = {}) const;
  std::uint64_t count(const JobFilter& filter) const;
  struct Problem {
    std::int64_t id = 0;
    std::string watch;
    std::string source;
    bool operator==(const Problem&) const = default;
  };
  /// All failed and quarantined jobs, or those of one problem (JobProblem::key), by their IDs.
  std::vector<Problem> with_problems(const std::string& problem) const;
  /// The first `limit` of them, the one with the newest job first.
  std::vector<JobProblem> problems(std::size_t limit) const;
  /// The first `limit` jobs above the id `after`, in the order of ids, that are done or cancelled for `age_ms`
  /// milliseconds or longer.
  std::vector<Job> over_since(std::int64_t age_ms, std::int64_t after, std::size_t limit) const;
  /// By watch; watches without jobs are absent.
  std::map<std::string, JobCounts> counts() const;
  /// Source bytes of the jobs that wait, by watch; watches without such jobs are absent.
  std::map<std::string, std::uint64_t> waiting_bytes() const;
  /// The first `limit` jobs of a watch that are waiting and due, in the order of `priority`.
  std::vector<Job> candidates(const std::string& watch, Priority priority, std::size_t limit) const;
  /// Milliseconds until a waiting job that is not due yet becomes so; nullopt: there is none.
  std::optional<std::int64_t> next_due_ms() const;
  /// Milliseconds since the job longest in the queue became complete; nullopt: none is waiting.
  std::optional<std::int64_t> queue_age_ms() const;

 private:
  std::int64_t now();
  bool move(std::int64_t id, std::initializer_list<JobState> from, JobState to, const std::string& reason);
  bool end_attempt(std::int64_t id, const JobResult& result, JobState to, int attempts, std::int64_t delay_ms);

  Clock clock_;
  std::int64_t latest_ = 0;  ///< what the clock said last
  std::string notice_;
  Database database_;
};

}  // namespace weir
