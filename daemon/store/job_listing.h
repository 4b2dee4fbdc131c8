// What can be asked of the jobs in the state file. job_store.h moves them from
// state to state.
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

/// Those that a person has to look at.
inline constexpr std::initializer_list<JobState> kProblemStates{JobState::failed, JobState::quarantined};
/// Those that are forgotten with their source, or their watch.
inline constexpr std::initializer_list<JobState> kForgottenStates{JobState::discovered, JobState::waiting,
                                                                  JobState::failed, JobState::quarantined};
/// In SQL: "state IN ('waiting')".
std::string in_state(std::initializer_list<JobState> states);

/// All throw Error(io) where the file cannot be read.
class JobListing {
 public:
  /// Milliseconds since the epoch.
  using Clock = std::function<std::int64_t()>;

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
  /// IDs of those that are done and whose thumbnails have not come, in their order.
  std::vector<std::int64_t> unrendered() const;
  struct Source {
    std::int64_t id = 0;
    std::string source;
    std::int64_t mtime_ns = 0;
    bool operator==(const Source&) const = default;
  };
  /// Which job sources() goes on behind; as it is made: before the first.
  struct SourcePlace {
    std::int64_t mtime_ns = std::numeric_limits<std::int64_t>::min();
    std::int64_t id = 0;
  };
  /// Of the jobs of `watch` that are in `state`, by time and ID, the first `limit` behind `place`: a piece of what may
  /// be a hundred thousand.
  std::vector<Source> sources(const std::string& watch, JobState state, const SourcePlace& place,
                              std::size_t limit) const;
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

 protected:
  JobListing(Clock clock, Database database) : clock_(std::move(clock)), database_(std::move(database)) {}
  ~JobListing() = default;

  Clock clock_;
  Database database_;
};

}  // namespace weir
