// The part of JobRunner that handles full file systems and outputs that another process writes, and reports both.
#include <algorithm>
#include <filesystem>
#include <optional>

#include "daemon/disks/disk_room.h"
#include "daemon/jobs/job_runner.h"
#include "format/base/error.h"
#include "format/base/text.h"

namespace weir {
namespace {

/// Delay before a job is tried again if no event says when its obstacle is gone.
constexpr std::int64_t kAgain_ms = 30'000;

}  // namespace

void JobRunner::disk_full(const RunningJob& run, const TaskReport& report) {
  const std::string& directory = report.full_directory;
  const ConversionTask& task = run.work->task();
  const DiskRoom room = room_in(directory);  // as it is now: the file system has just answered the job
  const bool of_output = room.device == room_in(std::filesystem::path(task.output).parent_path().string()).device;
  // Waiting makes no disk larger, so the job fails. Some file systems do not report a size, for example a server
  // behind FUSE.
  if (of_output && room.total > 0 && report.planned_bytes > room.total) {
    TaskReport never = report;
    never.result.reason =
        cat(directory, ": ", format_bytes(report.planned_bytes), " are needed, and its whole file system has ",
            format_bytes(room.total), "; choose another output or a smaller size");
    failed(run, never);
    return;
  }
  figures_.attempt_failed("disk-full");
  hold_disk(run, report, room, of_output ? report.planned_bytes : 0);
  // next_job() checks only the file systems of the output and of work_dir. The full one may be another one: for
  // example, an output in memory spills to /var/tmp.
  const bool asked_for = of_output || (!task.work_dir.empty() && room.device == room_in(task.work_dir).device);
  const std::int64_t delay_ms = asked_for ? 0 : kAgain_ms;
  writes_.add(
      [this, id = run.job.id, reason = report.result.reason, delay_ms] { store_.postpone(id, reason, delay_ms); });
}

// `needed` is the size of the output on the full file system in bytes; 0: not known, or no output was written to it.
void JobRunner::hold_disk(const RunningJob& run, const TaskReport& report, const DiskRoom& room, std::uint64_t needed) {
  const std::string& directory = report.full_directory;
  full_disks_.add(room.device, directory, room.free, run.job.id, run.job.identity.bytes, needed,
                  std::chrono::steady_clock::now());
  for (const std::string& full : full_disks_.directories()) disks_.look_anew(full);
  log_.error("disk-full", {{"job", run.job.id}, {"directory", directory}, {"reason", report.result.reason}});
}

// Postpones the job. The wait counts as no failure of the job, however long it takes.
void JobRunner::output_busy(const RunningJob& run, const TaskReport& report) {
  const std::string& reason = report.result.reason;
  if (run.job.result.reason != reason) log_.warn("output-busy", {{"job", run.job.id}, {"reason", reason}});
  writes_.add([this, id = run.job.id, reason] { store_.postpone(id, reason, kAgain_ms); });
}

void JobRunner::look_at_disks() {
  mounts_.look();
  const auto free_of = [this](const std::string& directory) {
    return disks_.room(directory).value_or(DiskRoom{}).free;
  };
  for (const std::string& directory : full_disks_.look(free_of, std::chrono::steady_clock::now())) {
    log_.info("disk-has-room", {{"directory", directory}, {"free", format_bytes(free_of(directory))}});
  }
}

std::string JobRunner::hold() const {
  if (!writes_.fault().empty()) return writes_.fault();
  if (no_disk_has_room()) return waits_for_disks();
  return scheduler_.paused() ? "paused by request" : "";
}

// Returns whether no job can start for want of disk space. A disk that was never looked at is not counted: while any
// disk is full, no job starts on it either.
bool JobRunner::no_disk_has_room() const {
  if (full_disks_.empty()) return false;
  const std::string& work_dir = config_.service.work_dir;
  const auto work_room = work_dir.empty() ? std::nullopt : disks_.room(work_dir);
  if (work_room && !hold_of(*work_room).empty()) return true;
  const std::vector<OutputDisk> all = disks();
  const auto is_full = [this](const OutputDisk& disk) { return !hold_of(disk.room).empty(); };
  const auto is_missing = [this](const OutputDisk& disk) {
    return std::ranges::all_of(disk.directories, [this](const auto& output) { return is_on_missing_mount(output); });
  };
  return (all.empty() || std::ranges::any_of(all, is_full)) &&
         std::ranges::all_of(all, [&](const OutputDisk& disk) { return is_full(disk) || is_missing(disk); });
}

// Returns whether all watches with this output wait until it is mounted.
bool JobRunner::is_on_missing_mount(const std::string& output) const {
  return std::ranges::none_of(config_.watches, [&](const WatchConfig& watch) {
    return watch.output == output && mounts_.mounted(watch.output_mount);
  });
}

// Postpones a job that failed because the file system of its output went away, as after `umount -l`. Returns whether it
// did. That is no fault of the job.
bool JobRunner::lost_output(const RunningJob& run, const TaskReport& report) {
  const bool by_disk = report.end == TaskEnd::disk_full ||
                       (report.end == TaskEnd::failed && report.result.exit_code == static_cast<int>(ErrorKind::io));
  if (!by_disk || run.output_mount.empty()) return false;
  const MountTable table = MountTable::read();
  if (table.empty() || table.mounted(run.output_mount)) return false;
  mounts_.look();
  const std::string& reason = report.result.reason;
  log_.warn("output-lost", {{"job", run.job.id}, {"mount", run.output_mount}, {"reason", reason}});
  writes_.add([this, id = run.job.id, reason] { store_.postpone(id, reason); });
  return true;
}

std::string JobRunner::waits_for_disks() const {
  const std::string room = waits_for_room();
  return cat(room, room.empty() || mounts_.all_mounted() ? "" : "; ", mounts_.text());
}

// Names the file systems without outputs first, for example that of work_dir, because all jobs may wait for them.
std::string JobRunner::waits_for_room() const {
  std::vector<std::string> others = full_disks_.directories();
  std::vector<std::string> held;
  for (const OutputDisk& disk : disks()) {
    std::erase(others, full_disks_.directory_on(disk.room.device));
    if (const std::string of_outputs = hold_of(disk.room); !of_outputs.empty()) held.push_back(of_outputs);
  }
  std::string text;
  for (const std::string& directory : others) text += cat(text.empty() ? "" : "; ", "no room in ", directory);
  for (const std::string& of_outputs : held) text += cat(text.empty() ? "" : "; ", of_outputs);
  return text;
}

std::string JobRunner::hold_of(const DiskRoom& disk) const { return full_disks_.hold_of(disk); }

std::vector<OutputDisk> JobRunner::disks() const { return disks_.disks(std::chrono::steady_clock::now()); }

}  // namespace weir
