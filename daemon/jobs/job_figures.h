// How many jobs there were and how fast they went, for the page and /metrics.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <string>

#include "daemon/disks/recent_rate.h"
#include "daemon/jobs/seconds_histogram.h"
#include "daemon/store/job.h"

namespace weir {

/// Since the start of the process.
struct JobTotals {
  SecondsHistogram seconds;  ///< of conversions that ended well
  std::uint64_t done = 0;
  std::uint64_t bytes_in = 0;   ///< of the sources of those
  std::uint64_t bytes_out = 0;  ///< of their outputs
  /// Failed attempts, by what was wrong; all of them from the start on, so that a rate can be taken of the first one.
  std::map<std::string, std::uint64_t> errors{{"input", 0},    {"io", 0},     {"budget", 0},    {"usage", 0},
                                              {"internal", 0}, {"killed", 0}, {"disk-full", 0}, {"source-changed", 0}};
};

class JobFigures {
 public:
  /// A conversion ended well; `bytes` are the source's.
  void converted(const std::string& watch, std::uint64_t bytes, const JobResult& result);
  /// A job waits no more, whatever became of it: done, failed or quarantined.
  void left_queue(std::uint64_t bytes) { left_.add(bytes, std::chrono::steady_clock::now()); }
  void attempt_failed(const std::string& kind) { ++totals_.errors[kind]; }
  /// The kind is that of weir convert's exit code.
  void attempt_failed(int exit_code);

  const JobTotals& totals() const { return totals_; }
  /// Source bytes a second, over the last minute.
  double bytes_per_s() const { return last_minute_.at(std::chrono::steady_clock::now()).bytes_per_s; }
  /// Of what was converted, over the last ten minutes; empty: of all watches.
  RecentRate::Rates converted(const std::string& watch = "") const;
  /// Of jobs that left the queue, over the last ten minutes.
  RecentRate::Rates left() const { return left_.at(std::chrono::steady_clock::now()); }

 private:
  static constexpr std::chrono::seconds kWindow{600};

  JobTotals totals_;
  std::chrono::steady_clock::time_point started_ = std::chrono::steady_clock::now();
  RecentRate left_{kWindow, started_};
  RecentRate last_minute_{std::chrono::seconds(60), started_};
  std::map<std::string, RecentRate> converted_;  ///< by watch; "": of all
};

}  // namespace weir
