// What a JobRunner does with thumbnails that are to come for jobs that are done: of those that the service ended
// before, and of those that found no room.
#include <algorithm>
#include <cstdint>
#include <iterator>
#include <optional>
#include <utility>
#include <vector>

#include "daemon/jobs/job_runner.h"

namespace weir {

void JobRunner::resume_thumbnails() {
  writes_.add([this] {
    std::vector<std::int64_t> ids = store_.unrendered();
    std::reverse(ids.begin(), ids.end());
    unrendered_.insert(unrendered_.begin(), ids.begin(), ids.end());
  });
}

bool JobRunner::start_next_rendering() {
  if (!full_disks_.empty()) return false;
  while (!unrendered_.empty()) {
    const std::int64_t id = unrendered_.back();
    unrendered_.pop_back();
    if (running_.contains(id)) continue;  // it was done again meanwhile
    const std::optional<Job> job = store_.job(id);
    if (!job || job->state != JobState::done) continue;
    const WatchConfig* watch = watch_of(job->watch);
    std::optional<ConversionTask> task;
    if (watch != nullptr) task = make_rendering_task(program_, config_.service, *watch, *job);
    if (task) {
      run(*job, *std::move(task));
      running_.at(id).only_rendering = true;
      return true;
    }
    writes_.add([this, id] { store_.finish_rendering(id, {}); });
  }
  return false;
}

// One that found no room is still to come, in the state file, too.
void JobRunner::rendering_ended(const RunningJob& run, const TaskReport& report) {
  const std::int64_t id = run.job.id;
  if (report.end == TaskEnd::disk_full) {
    hold_disk(run, report, 0);
    if (std::find(unrendered_.begin(), unrendered_.end(), id) == unrendered_.end()) {
      unrendered_.insert(unrendered_.begin(), id);
    }
  } else if (report.end == TaskEnd::done || !stopping_) {
    writes_.add([this, id, outputs = report.result.outputs] { store_.finish_rendering(id, outputs); });
  }
}

bool JobRunner::end_rendering(const Job& job) {
  const auto at = running_.find(job.id);
  if (at == running_.end() || !at->second.only_rendering) return false;
  log_.info("no-thumbnail", {{"job", job.id}, {"source", job.source}, {"reason", "cancelled"}});
  abandon(job.id);
  return true;
}

}  // namespace weir
