// Removes outdated jobs of a watch from the state file. This happens when the watch begins, and again when its
// directory is back. First the jobs are removed that the configuration no longer accepts, then the jobs whose files
// are gone. There may be a hundred thousand jobs: they are checked in pieces, and the service answers requests
// between the pieces.
#pragma once

#include <chrono>
#include <cstddef>
#include <vector>

#include "daemon/config/config.h"
#include "daemon/store/job_store.h"

namespace weir {

class KnownJobs {
 public:
  /// `watch` and `store` must outlive the object.
  KnownJobs(const WatchConfig& watch, JobStore& store) : watch_(watch), store_(store) {}

  /// How far the check has come.
  struct Progress {
    bool looks = false;     ///< all jobs were compared with the configuration; now their files are looked at
    std::size_t state = 0;  ///< index in kForgottenStates of the state that is being checked
    JobListing::SourcePlace place;
  };
  Progress progress() const { return progress_; }
  /// Goes back to `progress`, because the transaction of the steps since then was rolled back.
  void go_back_to(const Progress& progress) { progress_ = progress; }
  void begin_anew() { progress_ = {}; }

  bool over() const { return progress_.looks && progress_.state == kForgottenStates.size(); }
  /// Continues for about `time`, with at least one piece or one file, inside the caller's transaction. If the
  /// directory is missing, all files would seem to be gone. In this case no file is looked at, and the check ends.
  void step(std::chrono::steady_clock::duration time);

 private:
  using Time = std::chrono::steady_clock::time_point;

  void compare_piece();
  void look_at_piece(Time end);
  std::vector<JobListing::Source> piece() const;
  /// Moves the position behind `job`, or to the beginning of the next state if `job` is null.
  void go_behind(const JobListing::Source* job);

  const WatchConfig& watch_;
  JobStore& store_;
  Progress progress_;
};

}  // namespace weir
