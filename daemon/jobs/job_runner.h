// Runs the waiting jobs: takes them from the state file in the scheduler's order, starts their processes, and records
// the results. Lives on one thread, that of the io_context.
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "daemon/config/config.h"
#include "daemon/disks/full_disks.h"
#include "daemon/disks/output_disks.h"
#include "daemon/disks/output_mounts.h"
#include "daemon/jobs/conversion_job.h"
#include "daemon/jobs/job_figures.h"
#include "daemon/jobs/pending_writes.h"
#include "daemon/jobs/scheduler.h"
#include "daemon/jobs/source_deletion.h"
#include "daemon/log/event_log.h"
#include "daemon/store/job_store.h"
#include "format/io/descriptor.h"

namespace weir {

/// A conversion that reports nothing for this long is reported as stalled.
inline constexpr std::chrono::seconds kQuiet{60};
/// A conversion that computes for this long before its first report is reported as stalled, too.
inline constexpr std::chrono::seconds kOpening{300};

struct RunningJob {
  Job job;
  std::chrono::steady_clock::time_point begin;
  std::string output_mount;  ///< of the watch when the job began
  Descriptor mount;          ///< keeps the file system at output_mount from being unmounted; may be none
  std::unique_ptr<ConversionJob> work;
  bool stall_said = false;
  bool only_rendering = false;  ///< the job is done, its thumbnails are to come
};

class JobRunner {
 public:
  /// Called when the source of `job` was rewritten (the job is discovered again) or is gone (the job was removed).
  using LookAgain = std::function<void(const Job& job)>;

  /// `store` and `log` must outlive the runner. Nothing starts before configure().
  JobRunner(boost::asio::io_context& io, JobStore& store, const EventLog& log, std::string program,
            LookAgain look_again);

  /// Uses `config` from now on. Running jobs finish with the configuration they began with. Jobs that are not over are
  /// forgotten if their watch is gone, and found again if it comes back.
  void configure(const DaemonConfig& config);
  /// Queues the thumbnails that were missing when the service last ended; they go first. Call it after configure().
  /// Thumbnails wait while their disk is full or not mounted.
  void resume_thumbnails();
  /// Starts all jobs that can start now. Call it when a job became complete or due, or when a pause ended.
  void wake();

  void pause();
  void resume();
  /// Returns in words why no job starts: the state file cannot be written, no output's file system has room, or a pause
  /// was requested. Empty: nothing prevents it.
  std::string hold() const;
  /// Which file systems jobs wait for, because they are full or not mounted. Jobs on others go on. Empty: none.
  std::string waits_for_disks() const;
  bool paused() const { return scheduler_.paused(); }
  /// Looks whether the file systems of `output_mount` are mounted, as each start of a job does: an idle service looks
  /// at nothing by itself.
  void look_at_mounts() { mounts_.look(); }
  /// Returns whether a file system was last seen at `output_mount` of a watch.
  bool is_mounted(const std::string& output_mount) const { return mounts_.mounted(output_mount); }
  /// Returns why the state file cannot be written; empty if it can.
  const std::string& store_fault() const { return writes_.fault(); }

  /// Ends the job's processes if it runs, because its source was rewritten.
  void abandon(std::int64_t id);
  /// If the thumbnails of this done job are being rendered, gives them up. Returns whether they were being rendered.
  bool end_rendering(const Job& job);
  /// Ends the processes of a cancelled job if it runs, and removes the files from which it could be continued.
  void cancelled(const Job& job);
  /// Starts no more jobs, and calls `stopped` when none runs any more. A job that still runs after `grace` is abandoned
  /// and waits for the next start of the service. A process that cannot be killed is left behind.
  void shut_down(std::chrono::milliseconds grace, std::function<void()> stopped);
  /// Ends the grace of shut_down() at once, and kills the jobs. Call it after shut_down().
  void kill();

  const std::map<std::int64_t, RunningJob>& running() const { return running_; }
  const JobFigures& figures() const { return figures_; }
  /// The file systems that the watches' outputs lie on.
  std::vector<OutputDisk> disks() const;
  /// Returns in words why jobs with outputs on `disk` wait; empty if they do not.
  std::string hold_of(const DiskRoom& disk) const;

 private:
  bool start_next();
  bool start_next_rendering();
  void start(const WatchConfig& watch, const Job& job);
  void run(const Job& job, ConversionTask task, const std::string& output_mount, Descriptor mount);
  bool lost_output(const RunningJob& run, const TaskReport& report);
  void ended(std::int64_t id, const TaskReport& report);
  void attempt_ended(const RunningJob& run, const TaskReport& report);
  std::int64_t settle_ms(const Job& job) const;
  void source_changed(const Job& job);
  void discard_work(const Job& job, const std::string& directory) const;
  void done(const RunningJob& run, const TaskReport& report);
  void failed(const RunningJob& run, const TaskReport& report);
  void disk_full(const RunningJob& run, const TaskReport& report);
  void hold_disk(const RunningJob& run, const TaskReport& report, const DiskRoom& room, std::uint64_t needed);
  bool no_disk_has_room() const;
  std::string waits_for_room() const;
  bool rendering_waits(const WatchConfig& watch, const Job& job) const;
  bool is_on_missing_mount(const std::string& output) const;
  void rendering_ended(const RunningJob& run, const TaskReport& report);
  void end_stop_after(std::chrono::milliseconds patience);
  void end_stop();
  void output_busy(const RunningJob& run, const TaskReport& report);
  void forget_other_watches();
  void arm_timer();
  void look_at_disks();
  void look_for_stalls();
  std::optional<Job> next_job(const WatchConfig& watch) const;
  const WatchConfig* watch_of(const std::string& label) const;

  boost::asio::io_context& io_;
  JobStore& store_;
  const EventLog& log_;
  std::string program_;
  LookAgain look_again_;
  DaemonConfig config_;
  PendingWrites writes_;
  Scheduler scheduler_;
  FullDisks full_disks_;
  SourceDeletion deletion_;
  std::map<std::int64_t, RunningJob> running_;
  std::vector<std::int64_t> unrendered_;  ///< done jobs without their thumbnails; the last one is rendered next
  JobFigures figures_;
  OutputDisks disks_;
  OutputMounts mounts_;
  boost::asio::steady_timer timer_;
  boost::asio::steady_timer grace_timer_;
  std::function<void()> stopped_;
  bool stopping_ = false;
  bool killed_ = false;
};

}  // namespace weir
