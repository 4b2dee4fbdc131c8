// All jobs, in one SQLite file that outlives the daemon. A kill -9 or a power failure between any two statements
// loses no job: when a call has returned, its change is on disk. One thread. One process, which keeps the file locked
// while the store lives.
//
//   discovered --enqueue--> waiting --start--> running --finish--> done
//        ^                    ^  ^                |--fail--> waiting (later), failed, quarantined
//        |                    |  |---postpone-----|
//   observe (changed)       open (was running)
//   retry (what is over)                           cancel: discovered, waiting, running --> cancelled
//
// Every step names the state that it starts from, and returns false if the job is in another state or gone. So a late
// report of a job that was cancelled, or whose source was rewritten, changes nothing.
//
// All functions throw Error(io) if the file cannot be read or written (also for a full disk). In this case the store
// stays usable and unchanged, and the call may be repeated.
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

/// Returns the delay before the next attempt after `attempts` failed ones: 5 s, doubled each time, at most 10 min.
std::int64_t backoff_ms(int attempts);
/// Returns the largest number of attempts of a job that ends with `exit_code`. A job that fails because a device or a
/// file server is away, or for lack of memory, is tried for some twenty minutes. A job that fails by itself is given
/// up sooner.
int most_attempts(int exit_code);

class JobStore : public JobListing {
 public:
  static std::int64_t wall_clock_ms();

  /// Opens `path`; creates the file if it is missing. Jobs that were running become waiting; this counts as no
  /// attempt. A corrupt file is moved aside to PATH.corrupt-N, and an empty one is created. Throws Error(input) for a
  /// database of a newer weir or of another program, Error(io) if the file cannot be opened or another process has it
  /// open.
  explicit JobStore(const std::string& path, Clock clock = wall_clock_ms);

  /// Returns one line for the log about the opening; empty if there is nothing to report.
  const std::string& notice() const { return notice_; }

  /// Runs `steps` as one transaction: if one throws, all changes are undone. A thousand calls grouped this way cost
  /// one fsync. May be nested.
  void together(const std::function<void()>& steps);

  /// Returns whether enough was written since the last checkpoint() that the next one is due.
  bool checkpoint_due() const;
  /// Moves the written data from the journal into the file. This takes two flushes of the disk, for which a write
  /// would otherwise have to wait.
  void checkpoint() { database_.checkpoint(); }

  enum class Change { none, created, changed };
  struct Observation {
    Change change;
    Job job;  ///< the job as it is now
  };
  /// Records that the source was seen with `identity`. If the identity or `options` (any text that says how the job
  /// is converted) has changed, the job becomes discovered from any state, and its attempts and result are forgotten.
  /// Each change is a write to disk: for a growing file, observe only its beginning and its end.
  Observation observe(const std::string& watch, const std::string& source, const FileIdentity& identity,
                      const std::string& options);

  bool enqueue(std::int64_t id);  ///< discovered -> waiting
  bool start(std::int64_t id);    ///< waiting -> running
  /// running -> done. `rendering`: the thumbnails of its outputs are still missing.
  bool finish(std::int64_t id, const JobResult& result, bool rendering = false);
  /// Ends the rendering of a done job with missing thumbnails: takes the thumbnails of `outputs`, which may be empty.
  bool finish_rendering(std::int64_t id, const std::vector<JobOutput>& outputs);
  /// Returns the state of a job after its `attempts`-th attempt ended with `exit_code`: quarantined for exit code 3;
  /// failed for 2 and 4, which another attempt cannot change; otherwise waiting, or failed after the last of
  /// most_attempts.
  static JobState state_after(int exit_code, int attempts);
  /// running -> state_after; waiting for backoff_ms.
  bool fail(std::int64_t id, const JobResult& result);
  /// running -> waiting with `reason`, for at least `delay_ms`. Counts as no attempt: the disk is full, the source is
  /// being written to, or the service stops.
  bool postpone(std::int64_t id, const std::string& reason, std::int64_t delay_ms = 0);
  /// discovered, waiting or running -> quarantined: the source can never be complete.
  bool quarantine(std::int64_t id, const std::string& reason);
  bool cancel(std::int64_t id);  ///< discovered, waiting or running -> cancelled
  /// done, failed, quarantined or cancelled -> discovered, as if the source was just seen. A job that waits after a
  /// failure becomes due at once. In both cases the count of attempts starts anew. `force`: the job is converted even
  /// if its outputs are done.
  bool retry(std::int64_t id, bool force = false);
  /// Does the same as retry() if the job is failed or quarantined.
  bool retry_problem(std::int64_t id);
  /// Makes a job due at once that has failed, or waits after a failure, with exit code 5. The attempt counts as any
  /// other.
  bool hasten(std::int64_t id);
  /// Does the same as retry() for all jobs that failed with exit code 5. Called when the service starts, because the
  /// device or the access rights may have changed.
  void retry_failed_io();
  bool remove(std::int64_t id);  ///< forgets a job unless it is running (its source is gone)
  /// A watch of the present configuration. Jobs with its label and sources outside its directory belong to a former
  /// watch.
  struct Watched {
    std::string label;
    std::string directory;  ///< as in WatchConfig
  };
  /// Forgets the jobs of all other watches that are not over or have failed. Running jobs, results and cancelled jobs
  /// stay.
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

  std::int64_t latest_ = 0;  ///< the last time that the clock returned
  std::string notice_;
};

}  // namespace weir
