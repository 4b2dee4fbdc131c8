// Queries of the jobs in the state file. job_store.h changes the jobs.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "daemon/config/priority.h"
#include "daemon/store/job.h"
#include "daemon/store/job_order.h"
#include "daemon/store/sqlite.h"

namespace weir {

/// Selects the jobs to list; an empty member selects all.
struct JobFilter {
  std::optional<JobState> state;
  std::string watch;
  std::string text{};     ///< a part of the source's path or of the reason; ASCII letters match in either case
  std::string problem{};  ///< JobProblem::key; selects failed and quarantined jobs
};

/// Failed and quarantined jobs with equal reasons (problem_key.h).
struct JobProblem {
  std::string key;
  std::uint64_t count = 0;
  Job newest;
};

using JobCounts = std::array<std::uint64_t, kJobStates>;  ///< indexed by JobState

/// States of jobs that a person has to look at.
inline constexpr std::initializer_list<JobState> kProblemStates{JobState::failed, JobState::quarantined};
/// States of jobs that are forgotten when their source or their watch is gone.
inline constexpr std::initializer_list<JobState> kForgottenStates{JobState::discovered, JobState::waiting,
                                                                  JobState::failed, JobState::quarantined};
/// Returns the states as an SQL condition: "state IN ('waiting')".
std::string in_state(std::initializer_list<JobState> states);

/// All functions throw Error(io) if the file cannot be read.
class JobListing {
 public:
  /// Milliseconds since the epoch.
  using Clock = std::function<std::int64_t()>;

  std::optional<Job> job(std::int64_t id) const;
  std::optional<Job> find(const std::string& watch, const std::string& source) const;
  /// Returns jobs sorted by `order`. Without an order, the last changed job comes first; but if only waiting jobs are
  /// asked for, the job longest in the queue comes first.
  std::vector<Job> jobs(const JobFilter& filter, std::size_t offset, std::size_t limit,
                        const std::optional<JobOrder>& order = {}) const;
  std::uint64_t count(const JobFilter& filter) const;
  struct Problem {
    std::int64_t id = 0;
    std::string watch;
    std::string source;
    bool operator==(const Problem&) const = default;
  };
  /// Returns all failed and quarantined jobs, or those of one problem (JobProblem::key), sorted by ID.
  std::vector<Problem> with_problems(const std::string& problem) const;
  /// Returns the first `limit` problems; the problem with the newest job comes first.
  std::vector<JobProblem> problems(std::size_t limit) const;
  /// Returns the first `limit` jobs with an ID above `after`, sorted by ID, that have been done or cancelled for at
  /// least `age_ms` milliseconds.
  std::vector<Job> over_since(std::int64_t age_ms, std::int64_t after, std::size_t limit) const;
  /// Returns the IDs of done jobs whose thumbnails are missing, sorted.
  std::vector<std::int64_t> unrendered() const;
  struct Source {
    std::int64_t id = 0;
    std::string source;
    std::int64_t mtime_ns = 0;
    bool operator==(const Source&) const = default;
  };
  /// The job behind which sources() continues; by default, sources() begins with the first job.
  struct SourcePlace {
    std::int64_t mtime_ns = std::numeric_limits<std::int64_t>::min();
    std::int64_t id = 0;
  };
  /// Returns the first `limit` jobs of `watch` in `state` behind `place`, sorted by time and ID. There may be a
  /// hundred thousand jobs, so callers read them in pieces.
  std::vector<Source> sources(const std::string& watch, JobState state, const SourcePlace& place,
                              std::size_t limit) const;
  /// Returns the counts by watch; watches without jobs are absent.
  std::map<std::string, JobCounts> counts() const;
  /// Returns the source bytes of waiting jobs by watch; watches without waiting jobs are absent.
  std::map<std::string, std::uint64_t> waiting_bytes() const;
  /// Returns the first `limit` jobs of a watch that are waiting and due, in the order of `priority`.
  std::vector<Job> candidates(const std::string& watch, Priority priority, std::size_t limit) const;
  /// Returns the milliseconds until the next waiting job becomes due; nullopt if no waiting job has a delay.
  std::optional<std::int64_t> next_due_ms() const;
  /// Returns the milliseconds since the job longest in the queue became complete; nullopt if no job is waiting.
  std::optional<std::int64_t> queue_age_ms() const;

 protected:
  JobListing(Clock clock, Database database) : clock_(std::move(clock)), database_(std::move(database)) {}
  ~JobListing() = default;

  Clock clock_;
  Database database_;
};

}  // namespace weir
