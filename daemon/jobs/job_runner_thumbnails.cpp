// The part of JobRunner that renders missing thumbnails of done jobs: those left when the service ended, and those
// that found no disk space.
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
  constexpr std::size_t kMostLooked = 100;  // jobs on full or unmounted disks that are passed over
  std::size_t waiting = 0;
  for (std::size_t i = unrendered_.size(); i-- > 0 && waiting < kMostLooked;) {
    const std::int64_t id = unrendered_[i];
    std::optional<Job> job = store_.job(id);
    // The job may be converted again meanwhile.
    if (job && (job->state != JobState::done || running_.contains(id))) job.reset();
    const WatchConfig* watch = job ? watch_of(job->watch) : nullptr;
    if (watch != nullptr && rendering_waits(*watch, *job)) {
      ++waiting;
      continue;
    }
    Descriptor mount = hold_mount(watch == nullptr ? "" : watch->output_mount);
    if (mount) mounts_.look();
    if (watch != nullptr && !mounts_.mounted(watch->output_mount)) continue;
    unrendered_.erase(unrendered_.begin() + static_cast<std::ptrdiff_t>(i));
    if (!job) continue;
    std::optional<ConversionTask> task;
    if (watch != nullptr) task = make_rendering_task(program_, config_.service, *watch, *job);
    if (task) {
      run(*job, *std::move(task), watch->output_mount, std::move(mount));
      running_.at(id).only_rendering = true;
      return true;
    }
    writes_.add([this, id] { store_.finish_rendering(id, {}); });
  }
  return false;
}

// Also true if the room is not known yet: then the job waits for a later round.
bool JobRunner::rendering_waits(const WatchConfig& watch, const Job& job) const {
  if (!mounts_.mounted(watch.output_mount)) return true;
  if (full_disks_.empty()) return false;
  const std::optional<DiskRoom> room = disks_.room(output_directory(watch, job.source));
  return !room || !full_disks_.directory_on(room->device).empty();
}

// A rendering that found no room stays due, also in the state file.
void JobRunner::rendering_ended(const RunningJob& run, const TaskReport& report) {
  const std::int64_t id = run.job.id;
  if (report.end == TaskEnd::disk_full) {
    const DiskRoom room = room_in(report.full_directory);
    if (full_disks_.directory_on(room.device).empty()) hold_disk(run, report, room, 0);
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
