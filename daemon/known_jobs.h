// The jobs of a watch that are in the state file when the watch begins, or when its directory is there again. Those
// that the configuration no longer takes are forgotten, then those whose files are gone. They may be a hundred
// thousand: they are read and looked at in pieces, between which the service answers.
#pragma once

#include <chrono>
#include <cstddef>
#include <vector>

#include "daemon/config/config.h"
#include "daemon/store/job_store.h"

namespace weir {

class KnownJobs {
 public:
  /// Both must outlive the object.
  KnownJobs(const WatchConfig& watch, JobStore& store) : watch_(watch), store_(store) {}

  /// How far it is.
  struct Progress {
    bool looks = false;     ///< all have been compared with the configuration, and their files are looked at
    std::size_t state = 0;  ///< of kForgottenStates, whose jobs are next
    JobListing::SourcePlace place;
  };
  Progress progress() const { return progress_; }
  /// The steps since `progress` were taken back.
  void go_back_to(const Progress& progress) { progress_ = progress; }
  void begin_anew() { progress_ = {}; }

  bool over() const { return progress_.looks && progress_.state == kForgottenStates.size(); }
  /// Goes on for about as long as `time`, a piece or a file at least, inside the caller's transaction. Where the
  /// directory is not there, no file is looked at and it is over: all would seem to be gone.
  void step(std::chrono::steady_clock::duration time);

 private:
  using Time = std::chrono::steady_clock::time_point;

  void compare_piece();
  void look_at_piece(Time end);
  std::vector<JobListing::Source> piece() const;
  /// Behind `job`, or at the next state where there is none.
  void go_behind(const JobListing::Source* job);

  const WatchConfig& watch_;
  JobStore& store_;
  Progress progress_;
};

}  // namespace weir
