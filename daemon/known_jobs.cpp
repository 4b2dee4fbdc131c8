#include "daemon/known_jobs.h"

#include <algorithm>
#include <string>
#include <vector>

#include "daemon/store/file_identity.h"
#include "daemon/watch/path_filter.h"
#include "format/io/is_directory.h"

namespace weir {
namespace {

/// Number of jobs that are read at once.
constexpr std::size_t kReadAtOnce = 250;

}  // namespace

void KnownJobs::step(std::chrono::steady_clock::duration time) {
  const Time end = std::chrono::steady_clock::now() + time;
  do {
    if (over()) return;
    if (!progress_.looks) {
      compare_piece();
    } else if (is_directory(watch_.directory)) {
      look_at_piece(end);
    } else {
      progress_.state = kForgottenStates.size();
    }
  } while (std::chrono::steady_clock::now() < end);
}

void KnownJobs::compare_piece() {
  const std::vector<JobListing::Source> jobs = piece();
  const PathFilter filter(watch_);
  for (const JobListing::Source& job : jobs) {
    const std::string relative = job.source.substr(std::min(job.source.size(), watch_.directory.size() + 1));
    if (!filter.accepts_file(relative)) store_.remove(job.id);
  }
  go_behind(jobs.empty() ? nullptr : &jobs.back());
}

void KnownJobs::look_at_piece(Time end) {
  const std::vector<JobListing::Source> jobs = piece();
  if (jobs.empty()) go_behind(nullptr);
  for (const JobListing::Source& job : jobs) {
    if (is_gone_from(watch_.directory, job.source)) store_.remove(job.id);
    go_behind(&job);
    if (std::chrono::steady_clock::now() >= end) return;
  }
}

std::vector<JobListing::Source> KnownJobs::piece() const {
  return store_.sources(watch_.label, kForgottenStates.begin()[progress_.state], progress_.place, kReadAtOnce);
}

void KnownJobs::go_behind(const JobListing::Source* job) {
  if (job != nullptr) {
    progress_.place = {job->mtime_ns, job->id};
    return;
  }
  progress_.place = {};
  if (++progress_.state == kForgottenStates.size() && !progress_.looks) progress_ = {true, 0, {}};
}

}  // namespace weir
