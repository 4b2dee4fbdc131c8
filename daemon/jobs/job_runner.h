// Runs the waiting jobs: takes them from the state file in the scheduler's
// order, gives each its processes, and writes down what became of it. One thread,
// that of the io_context.
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

namespace weir {

/// A conversion that reports nothing for so long is reported as stalled.
inline constexpr std::chrono::seconds kQuiet{60};
/// So is one that computes for so long before it reports anything.
inline constexpr std::chrono::seconds kOpening{300};

struct RunningJob {
  Job job;
  std::chrono::steady_clock::time_point begin;
  std::unique_ptr<ConversionJob> work;
  bool stall_said = false;
  bool only_rendering = false;  ///< the job is done, its thumbnails are to come
};

class JobRunner {
 public:
  /// The source of `job` was rewritten, and the job is discovered again; or it is gone, and so is the job.
  using LookAgain = std::function<void(const Job& job)>;

  /// `store` and `log` must outlive the runner. Nothing starts before configure().
  JobRunner(boost::asio::io_context& io, JobStore& store, const EventLog& log, std::string program,
            LookAgain look_again);

  /// Takes `config` from now on; running jobs finish as they began. Jobs that are not over are forgotten where their
  /// watch is gone, and found again where it comes back.
  void configure(const DaemonConfig& config);
  /// Renders, before all else, the thumbnails that the service ended before; call it after configure(). These, and
  /// those that find no room, wait while their disk is full.
  void resume_thumbnails();
  /// Something may be able to start: a job became complete, or due, or a stop is over. Starts what can.
  void wake();

  void pause();
  void resume();
  /// Why nothing starts, in words: the state file cannot be written, no output's file system has room, or it was asked
  /// for. Empty: nothing prevents it.
  std::string hold() const;
  /// Which file systems jobs wait for, because they are full or not mounted. Jobs on others go on. Empty: none.
  std::string waits_for_disks() const;
  bool paused() const { return scheduler_.paused(); }
  /// Why the state file cannot be written; empty: it can.
  const std::string& store_fault() const { return writes_.fault(); }

  /// Ends the job's work, if it runs: its source was rewritten.
  void abandon(std::int64_t id);
  /// Gives up the thumbnails of a done job, if they are being rendered; whether they are.
  bool end_rendering(const Job& job);
  /// `job` was cancelled: ends its work, if it runs, and removes what it could be continued from.
  void cancelled(const Job& job);
  /// Starts nothing more; `stopped` is called when nothing runs any more. What still runs after `grace` is abandoned
  /// and waits for the next start of the service; a process that cannot be killed is left behind.
  void shut_down(std::chrono::milliseconds grace, std::function<void()> stopped);
  /// Ends shut_down's grace at once, without asking the jobs to end. To be called after it.
  void kill();

  const std::map<std::int64_t, RunningJob>& running() const { return running_; }
  const JobFigures& figures() const { return figures_; }
  /// The file systems that the watches' outputs lie on.
  std::vector<OutputDisk> disks() const;
  /// Why jobs with outputs on `disk` wait, in words; empty: they do not.
  std::string hold_of(const DiskRoom& disk) const;

 private:
  bool start_next();
  bool start_next_rendering();
  void start(const WatchConfig& watch, const Job& job);
  void run(const Job& job, ConversionTask task);
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
  bool rendering_waits(const WatchConfig& watch, const Job& job);
  void rendering_ended(const RunningJob& run, const TaskReport& report);
  void end_stop_after(std::chrono::milliseconds patience);
  void end_stop();
  void output_busy(const RunningJob& run, const TaskReport& report);
  void forget_other_watches();
  void arm_timer();
  void look_at_disks();
  void look_for_stalls();
  std::optional<Job> next_job(const WatchConfig& watch);
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
  std::vector<std::int64_t> unrendered_;  ///< done jobs whose thumbnails are to come, the next one last
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
