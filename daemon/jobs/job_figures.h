// Counts jobs and measures how fast they go, for the page and /metrics.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <string>

#include "daemon/disks/recent_rate.h"
#include "daemon/jobs/seconds_histogram.h"
#include "daemon/store/job.h"

namespace weir {

/// Totals since the start of the process.
struct JobTotals {
  SecondsHistogram seconds;  ///< of conversions that succeeded
  std::uint64_t done = 0;
  std::uint64_t bytes_in = 0;   ///< of the sources of these conversions
  std::uint64_t bytes_out = 0;  ///< of the outputs of these conversions
  /// Failed attempts by kind. All kinds are present from the start, so that a rate can be computed for the first
  /// failure.
  std::map<std::string, std::uint64_t> errors{{"input", 0},    {"io", 0},     {"budget", 0},    {"usage", 0},
                                              {"internal", 0}, {"killed", 0}, {"disk-full", 0}, {"source-changed", 0}};
};

class JobFigures {
 public:
  /// Counts a conversion that succeeded; `bytes` is the size of its source.
  void converted(const std::string& watch, std::uint64_t bytes, const JobResult& result);
  /// Counts a job that left the queue with any result: done, failed or quarantined.
  void left_queue(std::uint64_t bytes) { left_.add(bytes, std::chrono::steady_clock::now()); }
  void attempt_failed(const std::string& kind) { ++totals_.errors[kind]; }
  /// Counts the failure under the kind that belongs to weir convert's exit code.
  void attempt_failed(int exit_code);

  const JobTotals& totals() const { return totals_; }
  /// Returns source bytes per second over the last minute.
  double bytes_per_s() const { return last_minute_.at(std::chrono::steady_clock::now()).bytes_per_s; }
  /// Returns the rates of converted sources over the last ten minutes. An empty `watch` means all watches.
  RecentRate::Rates converted(const std::string& watch = "") const;
  /// Returns the rates of jobs that left the queue over the last ten minutes.
  RecentRate::Rates left() const { return left_.at(std::chrono::steady_clock::now()); }

 private:
  static constexpr std::chrono::seconds kWindow{600};

  JobTotals totals_;
  std::chrono::steady_clock::time_point started_ = std::chrono::steady_clock::now();
  RecentRate left_{kWindow, started_};
  RecentRate last_minute_{std::chrono::seconds(60), started_};
  std::map<std::string, RecentRate> converted_;  ///< by watch; the key "" is for all watches
};

}  // namespace weir
