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

#include <cstdint>
#include <functional>
#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

#include "daemon/store/job.h"
#include "daemon/store/job_listing.h"
#include "daemon/store/sqlite.h"

namespace weir {

/// Delay before the next attempt after `attempts` failed ones: 5 s, doubling, 10 min at most.
std::int64_t backoff_ms(int attempts);
/// Attempts in all of a job that ends with `exit_code`. What fails by a device or a file server that is away, or for
/// lack of memory, gets some twenty minutes; what fails by itself is soon given up.
int most_attempts(int exit_code);

class JobStore : public JobListing {
 public:
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
    Job job;  ///< as it is now
  };
  /// The source was seen with that identity. A job whose identity or `options` changed (any text that says how
  /// it is converted) is discovered again, from any state, with its attempts and result forgotten. Each change is
  /// a write to disk: for a file that is still growing, observe its beginning and its end.
  Observation observe(const std::string& watch, const std::string& source, const FileIdentity& identity,
                      const std::string& options);

  bool enqueue(std::int64_t id);  ///< discovered -> waiting
  bool start(std::int64_t id);    ///< waiting -> running
  /// running -> done. `rendering`: thumbnails of its outputs are still to come.
  bool finish(std::int64_t id, const JobResult& result, bool rendering = false);
  /// Of a done job whose thumbnails were to come: they are those of `outputs`, or none came.
  bool finish_rendering(std::int64_t id, const std::vector<JobOutput>& outputs);
  /// What becomes of a job whose attempt ended with that exit code, the `attempts`-th one: quarantined for exit code 3;
  /// failed for 2 and 4, which another attempt cannot change; else waiting, and failed at the last of most_attempts.
  static JobState state_after(int exit_code, int attempts);
  /// running -> state_after; waiting for backoff_ms.
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

 private:
  struct Opened {
    Database database;
    std::string notice;
  };
  static Opened open(const std::string& path);
  JobStore(Opened opened, Clock clock);

  std::int64_t now();
  bool move(std::int64_t id, std::initializer_list<JobState> from, JobState to, const std::string& reason);
  bool end_attempt(std::int64_t id, const JobResult& result, JobState to, int attempts, std::int64_t delay_ms);

  std::int64_t latest_ = 0;  ///< what the clock said last
  std::string notice_;
};

}  // namespace weir
