// Decides which watch may start its next job, and when nothing may start. Pure: the caller passes the time and the
// memory, and starts the jobs. Within a watch, JobStore::candidates decides the order.
//
// Fair: among the watches with a waiting job, the watch with the fewest running jobs goes first. Among equals, the
// watch whose last start is longest ago goes first, so that a watch with ten thousand files does not hold up one with
// a single file.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>

namespace weir {

/// The state of one watch.
struct WatchLoad {
  std::string label;
  bool waiting = false;  ///< a job is waiting and due
  int running = 0;
};

struct SchedulerLimits {
  int jobs = 1;                  ///< jobs that run at the same time
  std::uint64_t job_memory = 0;  ///< bytes that a job may take; 0: memory is not checked
  std::uint64_t bandwidth = 0;   ///< bytes per second that all jobs together may read; 0: no limit
};

class Scheduler {
 public:
  using Time = std::chrono::steady_clock::time_point;

  explicit Scheduler(const SchedulerLimits& limits) : limits_(limits) {}
  void set_limits(const SchedulerLimits& limits) { limits_ = limits; }

  /// Returns the watch whose next job may start now; none if nothing waits or nothing may start. `available_memory`
  /// is the number of bytes that this process and its jobs can still take. Too little memory holds up all jobs but
  /// the first: if no job runs, one may start in any case.
  std::optional<std::string> next(std::span<const WatchLoad> watches, std::uint64_t available_memory, Time now) const;

  void started(const std::string& label);
  /// Records that a job that began at `begin` has read `bytes`. If it read faster than the bandwidth allows, nothing
  /// starts until the average is within the limit. Each conversion limits itself; this limits many short jobs, too.
  void finished(std::uint64_t bytes, Time begin);
  /// Returns when the bandwidth allows the next start; none if it allows one now.
  std::optional<Time> bandwidth_until(Time now) const;

  /// Pause and resume are a user's requests.
  void pause() { paused_ = true; }
  void resume() { paused_ = false; }
  bool paused() const { return paused_; }

 private:
  SchedulerLimits limits_;
  std::map<std::string, std::uint64_t> last_start_;  ///< by label: the sequence number of the watch's last start
  std::uint64_t starts_ = 0;
  bool paused_ = false;
  Time paid_until_{};  ///< from this time on, the bytes read so far are within the bandwidth
};

}  // namespace weir
