// What a JobRunner does where a file system has no room or an output another writer, and what it says of that.
#include <filesystem>

#include "daemon/disks/disk_room.h"
#include "daemon/jobs/job_runner.h"
#include "format/base/text.h"

namespace weir {

void JobRunner::disk_full(const RunningJob& run, const TaskReport& report) {
  const std::string& directory = report.full_directory;
  const DiskRoom room = room_in(directory);  // as it is now: it has just answered the job
  const bool of_output =
      room.device == room_in(std::filesystem::path(run.work->task().output).parent_path().string()).device;
  // Waiting makes no disk larger. Of some, as of a file server behind FUSE, the size is not told.
  if (of_output && room.total > 0 && report.planned_bytes > room.total) {
    TaskReport never = report;
    never.result.reason =
        cat(directory, ": ", format_bytes(report.planned_bytes), " are needed, and its whole file system has ",
            format_bytes(room.total), "; choose another output or a smaller size");
    failed(run, never);
    return;
  }
  figures_.attempt_failed("disk-full");
  full_disks_.add(room.device, directory, room.free, run.job.id, run.job.identity.bytes,
                  of_output ? report.planned_bytes : 0, std::chrono::steady_clock::now());
  for (const std::string& full : full_disks_.directories()) disks_.look_anew(full);
  log_.error("disk-full", {{"job", run.job.id}, {"directory", directory}, {"reason", report.result.reason}});
  writes_.add([this, id = run.job.id, reason = report.result.reason] { store_.postpone(id, reason); });
}

// However long that takes, it is no fault of the job.
void JobRunner::output_busy(const RunningJob& run, const TaskReport& report) {
  constexpr std::int64_t kBusyAgain_ms = 30'000;
  const std::string& reason = report.result.reason;
  if (run.job.result.reason != reason) log_.warn("output-busy", {{"job", run.job.id}, {"reason", reason}});
  writes_.add([this, id = run.job.id, reason] { store_.postpone(id, reason, kBusyAgain_ms); });
}

void JobRunner::look_at_disks() {
  const auto free_of = [this](const std::string& directory) {
    return disks_.room(directory).value_or(DiskRoom{}).free;
  };
  for (const std::string& directory : full_disks_.look(free_of, std::chrono::steady_clock::now())) {
    log_.info("disk-has-room", {{"directory", directory}, {"free", format_bytes(free_of(directory))}});
  }
}

std::string JobRunner::hold() const {
  if (!writes_.fault().empty()) return writes_.fault();
  std::string full;
  for (const OutputDisk& disk : disks()) {
    const std::string held = hold_of(disk.room);
    if (!held.empty()) full += cat(full.empty() ? "" : "; ", held);
  }
  if (full.empty() && !full_disks_.empty()) full = cat("no room in ", full_disks_.directories().front());
  if (!full.empty()) return full;
  return scheduler_.paused() ? "paused by request" : "";
}

std::string JobRunner::hold_of(const DiskRoom& disk) const { return full_disks_.hold_of(disk); }

std::vector<OutputDisk> JobRunner::disks() const { return disks_.disks(std::chrono::steady_clock::now()); }

}  // namespace weir
