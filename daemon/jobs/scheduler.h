// Which watch's turn it is, and when nothing may start. Pure: it is told the
// time and the memory, and starts nothing itself. Within a
// watch the order is the state file's (JobStore::candidates).
//
// Fair: of the watches that have something waiting, the one with the fewest jobs
// running goes first, then the one whose last start is longest ago, so that a
// watch with ten thousand files does not hold up one with a single file.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>

namespace weir {

/// What one watch has to do.
struct WatchLoad {
  std::string label;
  bool waiting = false;  ///< a job is waiting and due
  int running = 0;
};

struct SchedulerLimits {
  int jobs = 1;                  ///< at once
  std::uint64_t job_memory = 0;  ///< bytes that a job may take; 0: not looked at
  std::uint64_t bandwidth = 0;   ///< bytes per second that all jobs together may read; 0: no limit
};

class Scheduler {
 public:
  using Time = std::chrono::steady_clock::time_point;

  explicit Scheduler(const SchedulerLimits& limits) : limits_(limits) {}
  void set_limits(const SchedulerLimits& limits) { limits_ = limits; }

  /// The watch whose next job may start now; none where nothing waits or something stands against it.
  /// `available_memory`: bytes that this process and its jobs can still take. It holds up all but the first job, which
  /// runs in any case.
  std::optional<std::string> next(std::span<const WatchLoad> watches, std::uint64_t available_memory, Time now) const;

  void started(const std::string& label);
  /// A job that began at `begin` has read `bytes`. Where that was faster than the bandwidth allows, nothing
  /// starts until it is not: many short jobs keep to the cap, too, which each conversion keeps to by itself.
  void finished(std::uint64_t bytes, Time begin);
  /// When the bandwidth allows the next start; none where it does now.
  std::optional<Time> bandwidth_until(Time now) const;

  /// By a user.
  void pause() { paused_ = true; }
  void resume() { paused_ = false; }
  bool paused() const { return paused_; }

 private:
  SchedulerLimits limits_;
  std::map<std::string, std::uint64_t> last_start_;  ///< by label: the number of that start
  std::uint64_t starts_ = 0;
  bool paused_ = false;
  Time paid_until_{};  ///< what was read is within the bandwidth from here on
};

}  // namespace weir
