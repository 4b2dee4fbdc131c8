#include "daemon/jobs/job_runner.h"

#include <algorithm>
#include <boost/asio/post.hpp>
#include <cmath>
#include <filesystem>
#include <utility>

#include "daemon/jobs/output_cleaning.h"
#include "daemon/store/file_identity.h"
#include "daemon/watch/source_identity.h"
#include "format/base/error.h"
#include "format/base/text.h"
#include "format/io/is_directory.h"
#include "format/process/process_memory.h"

namespace weir {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

/// How often full disks, missing mounts, a state file that cannot be written and short memory are looked at again.
constexpr milliseconds kLook{1000};
/// How long a process that was asked to end may take before it is killed.
constexpr milliseconds kAbandon{5000};
/// How long a killed process may take to end before it is left behind.
constexpr milliseconds kLeave{1000};

std::string seconds_text(double seconds) { return cat(static_cast<double>(static_cast<long>(seconds * 1000)) / 1000); }

}  // namespace

JobRunner::JobRunner(boost::asio::io_context& io, JobStore& store, const EventLog& log, std::string program,
                     LookAgain look_again)
    : io_(io),
      store_(store),
      log_(log),
      program_(std::move(program)),
      look_again_(std::move(look_again)),
      writes_(log),
      scheduler_(SchedulerLimits{}),
      deletion_(io, store, log, [this] { return stopping_ || scheduler_.paused(); }),
      mounts_(log),
      timer_(io),
      grace_timer_(io) {}

void JobRunner::configure(const DaemonConfig& config) {
  config_ = config;
  const ServiceConfig& service = config.service;
  scheduler_.set_limits({service.jobs, job_memory(service), service.bandwidth});
  forget_other_watches();
  std::vector<std::string> outputs;
  std::vector<std::string> mounts;
  for (const WatchConfig& watch : config.watches) {
    outputs.push_back(watch.output);
    mounts.push_back(watch.output_mount);
  }
  disks_.watch(outputs);
  mounts_.watch(mounts);
  writes_.add([this] { deletion_.configure(config_); });
}

void JobRunner::forget_other_watches() {
  std::vector<JobStore::Watched> watches;
  for (const WatchConfig& watch : config_.watches) watches.push_back({watch.label, watch.directory});
  writes_.add([this, watches] { store_.forget_other_watches(watches); });
}

const WatchConfig* JobRunner::watch_of(const std::string& label) const {
  const auto at = std::find_if(config_.watches.begin(), config_.watches.end(),
                               [&](const WatchConfig& watch) { return watch.label == label; });
  return at == config_.watches.end() ? nullptr : &*at;
}

void JobRunner::wake() {
  try {
    while (start_next()) {
    }
    writes_.clear_fault();
  } catch (const CorruptDatabase&) {
    throw;
  } catch (const Error& error) {  // an error of the state file; nothing was changed
    writes_.log_fault(error);
  }
  arm_timer();
}

bool JobRunner::start_next() {
  if (stopping_ || !writes_.empty() || running_.size() >= static_cast<std::size_t>(config_.service.jobs)) return false;
  mounts_.look();
  if (!paused() && start_next_rendering()) return true;
  std::vector<WatchLoad> loads;
  std::map<std::string, Job> first;
  for (const WatchConfig& watch : config_.watches) {
    WatchLoad load{watch.label, false, 0};
    for (const auto& [id, run] : running_) load.running += run.job.watch == watch.label ? 1 : 0;
    if (const std::optional<Job> job = next_job(watch)) {
      first.emplace(watch.label, *job);
      load.waiting = true;
    }
    loads.push_back(std::move(load));
  }
  const auto label = scheduler_.next(loads, available_bytes(), Clock::now());
  if (!label) return false;
  start(*watch_of(*label), first.at(*label));
  return true;
}

// Returns the first job that may start. A job may not while processes of its last attempt are ending or room is short.
std::optional<Job> JobRunner::next_job(const WatchConfig& watch) const {
  constexpr std::size_t kMostLooked = 100;  // to find a job that fits if the first does not
  const std::size_t looked = full_disks_.empty() ? running_.size() + 1 : kMostLooked;
  const std::vector<Job> candidates = store_.candidates(watch.label, watch.priority, looked);
  // WatchedTree wakes the runner when a missing directory is back.
  if (candidates.empty() || !is_directory(watch.directory)) return std::nullopt;
  if (!mounts_.mounted(watch.output_mount)) return std::nullopt;
  for (const Job& job : candidates) {
    if (running_.contains(job.id)) continue;
    if (full_disks_.empty()) return job;
    // While the room is not known, the job does not start. The next round asks again.
    const auto has_room = [&](const std::string& directory) {
      const std::optional<DiskRoom> room = disks_.room(directory);
      return room && full_disks_.admits(room->device, job.id, job.identity.bytes);
    };
    const std::string& work_dir = config_.service.work_dir;
    const bool fits_work = work_dir.empty() || has_room(work_dir);
    if (has_room(output_directory(watch, job.source)) && fits_work) return job;
  }
  return std::nullopt;
}

void JobRunner::start(const WatchConfig& watch, const Job& job) {
  // A retried job, after its watch was given another directory: no place is defined for its output.
  if (!is_source_of(watch, job.source)) {
    log_.warn("not-watched", {{"job", job.id}, {"source", job.source}, {"directory", watch.directory}});
    store_.cancel(job.id);
    return;
  }
  // The watch no longer takes the source. KnownJobs removes such jobs, but may not have reached this one yet.
  if (!takes_source(watch, job.source)) {
    store_.remove(job.id);
    return;
  }
  Descriptor mount = hold_mount(watch.output_mount);
  mounts_.look();
  if (!mounts_.mounted(watch.output_mount)) return;
  scheduler_.started(watch.label);
  const auto now = identify_source(job.source, watch.convert_options);
  if (now ? *now != job.identity : is_gone_from(watch.directory, job.source)) {
    source_changed(job);
    return;
  }
  if (!store_.start(job.id)) return;
  log_.info("start", {{"job", job.id}, {"source", job.source}, {"bytes", job.identity.bytes}});
  run(job, make_task(program_, config_.service, watch, job), watch.output_mount, std::move(mount));
}

void JobRunner::run(const Job& job, ConversionTask task, const std::string& output_mount, Descriptor mount) {
  RunningJob& run = running_[job.id];
  run.job = job;
  run.output_mount = output_mount;
  run.mount = std::move(mount);
  run.begin = Clock::now();
  run.work = std::make_unique<ConversionJob>(io_, std::move(task),
                                             [this, id = job.id](const TaskReport& report) { ended(id, report); });
}

void JobRunner::ended(std::int64_t id, const TaskReport& report) {
  if (report.rendering) {
    RunningJob& run = running_.at(id);
    run.only_rendering = true;
    done(run, report);
    return;
  }
  const RunningJob run = std::move(running_.extract(id).mapped());
  for (const std::string& notice : report.notices) log_.warn("notice", {{"job", id}, {"reason", notice}});
  scheduler_.finished(report.result.bytes_read, run.begin);
  if (run.only_rendering) {
    rendering_ended(run, report);
  } else {
    attempt_ended(run, report);
  }
  writes_.add([this, job = run.job, directory = fs::path(run.work->task().output).parent_path().string()] {
    const std::optional<Job> now = store_.job(job.id);
    if (now && now->state == JobState::cancelled) discard_work(job, directory);
  });
  if (const WatchConfig* watch = watch_of(run.job.watch); watch == nullptr || !is_source_of(*watch, run.job.source)) {
    forget_other_watches();
  }
  if (stopping_ && running_.empty()) end_stop();
  wake();
}

void JobRunner::attempt_ended(const RunningJob& run, const TaskReport& report) {
  const std::int64_t id = run.job.id;
  if (lost_output(run, report)) return;
  switch (report.end) {
    case TaskEnd::done:
      done(run, report);
      break;
    case TaskEnd::failed:
      failed(run, report);
      break;
    case TaskEnd::disk_full:
      disk_full(run, report);
      break;
    case TaskEnd::output_busy:
      output_busy(run, report);
      break;
    case TaskEnd::source_changed:
      figures_.attempt_failed("source-changed");
      [[fallthrough]];
    case TaskEnd::source_gone:
      log_.info(report.end == TaskEnd::source_gone ? "source-gone" : "source-changed",
                {{"job", id}, {"source", run.job.source}});
      writes_.add([this, job = run.job, delay_ms = settle_ms(run.job)] {
        store_.postpone(job.id, "the source changed", delay_ms);
        source_changed(job);
      });
      break;
    case TaskEnd::stopped:
      log_.info("stopped", {{"job", id}, {"source", run.job.source}});
      writes_.add([this, id] { store_.postpone(id, "stopped with the service"); });
      break;
  }
}

// A plane of a stack or the data file of a header may still be written to while the watched file itself is unchanged.
// Then only this delay keeps the next attempt from beginning at once.
std::int64_t JobRunner::settle_ms(const Job& job) const {
  const WatchConfig* watch = watch_of(job.watch);
  const double settle_s = watch == nullptr ? WatchConfig{}.settle_s : watch->settle_s;
  return std::max<std::int64_t>(1, std::llround(settle_s * 1000));
}

// The job is waiting. If its source can be identified, the job gets the new identity. If the source is certainly gone,
// the job is removed; while that cannot be known, it stays as it is.
void JobRunner::source_changed(const Job& job) {
  const WatchConfig* watch = watch_of(job.watch);
  if (const auto now =
          identify_source(job.source, watch == nullptr ? std::vector<std::string>() : watch->convert_options)) {
    store_.observe(job.watch, job.source, *now, job.options);
  } else if (watch == nullptr ? is_gone(job.source) : is_gone_from(watch->directory, job.source)) {
    store_.remove(job.id);
  }
  look_again_(job);
}

void JobRunner::done(const RunningJob& run, const TaskReport& report) {
  const JobResult& result = report.result;
  writes_.add([this, id = run.job.id, result, rendering = report.rendering] {
    store_.finish(id, result, rendering);
    deletion_.done(id);
  });
  figures_.left_queue(run.job.identity.bytes);
  std::uint64_t bytes_out = 0;
  for (const JobOutput& output : result.outputs) bytes_out += output.bytes;
  log_.info("done", {{"job", run.job.id},
                     {"source", run.job.source},
                     {"seconds", seconds_text(result.seconds)},
                     {"outputs", result.outputs.size()},
                     {"bytes", bytes_out},
                     {"converted", report.converted ? "yes" : "no, done already"}});
  if (!report.converted) return;
  figures_.converted(run.job.watch, std::max(run.job.identity.bytes, result.source_bytes), result);
  disks_.written(fs::path(run.work->task().output).parent_path().string(), result.bytes_written, Clock::now());
}

void JobRunner::failed(const RunningJob& run, const TaskReport& report) {
  figures_.attempt_failed(report.result.exit_code);
  const JobState state = JobStore::state_after(report.result.exit_code, run.job.attempts + 1);
  log_.error(state == JobState::waiting ? "attempt-failed" : job_state_name(state),
             {{"job", run.job.id},
              {"source", run.job.source},
              {"exit_code", report.result.exit_code},
              {"reason", report.result.reason}});
  writes_.add([this, id = run.job.id, bytes = run.job.identity.bytes, result = report.result] {
    store_.fail(id, result);
    const std::optional<Job> now = store_.job(id);
    if (now && now->state != JobState::waiting) figures_.left_queue(bytes);
  });
}

void JobRunner::look_for_stalls() {
  for (auto& [id, run] : running_) {
    run.work->look();
    const std::string stall = run.work->stall(kQuiet, kOpening);
    if (!stall.empty() && !run.stall_said) {
      log_.warn("stalled", {{"job", id}, {"source", run.job.source}, {"reason", stall}});
    }
    run.stall_said = !stall.empty();
  }
}

void JobRunner::arm_timer() {
  if (stopping_ && writes_.empty()) {
    timer_.cancel();
    return;
  }
  auto delay = milliseconds::max();
  const Clock::time_point now = Clock::now();
  if (!writes_.fault().empty() || !full_disks_.empty() || !mounts_.all_mounted() || !running_.empty()) delay = kLook;
  if (const auto until = scheduler_.bandwidth_until(now)) {
    delay = std::min(delay, std::chrono::ceil<milliseconds>(*until - now));
  }
  try {
    if (const auto due = store_.next_due_ms()) delay = std::min(delay, milliseconds(std::max<std::int64_t>(*due, 1)));
  } catch (const CorruptDatabase&) {
    throw;
  } catch (const Error&) {
    delay = kLook;
  }
  if (delay == milliseconds::max()) {
    timer_.cancel();
    return;
  }
  timer_.expires_after(delay);
  timer_.async_wait([this](boost::system::error_code error) {
    if (error) return;
    look_at_disks();
    look_for_stalls();
    writes_.write();
    wake();
  });
}

void JobRunner::pause() {
  if (!scheduler_.paused()) log_.info("pause", {});
  scheduler_.pause();
}

void JobRunner::resume() {
  if (scheduler_.paused()) log_.info("resume", {});
  scheduler_.resume();
  wake();
}

void JobRunner::abandon(std::int64_t id) {
  const auto at = running_.find(id);
  if (at != running_.end()) at->second.work->stop(kAbandon);
}

void JobRunner::cancelled(const Job& job) {
  log_.info("cancelled", {{"job", job.id}, {"source", job.source}});
  if (running_.contains(job.id)) {
    abandon(job.id);
  } else if (const WatchConfig* watch = watch_of(job.watch)) {
    discard_work(job, output_directory(*watch, job.source));
  }
}

// A user who cancels a job wants its disk space back. A retry then converts from the beginning.
void JobRunner::discard_work(const Job& job, const std::string& directory) const {
  const CleaningReport report = discard_interrupted(directory, job.source);
  for (const std::string& path : report.removed) log_.info("cleaned", {{"job", job.id}, {"removed", path}});
  for (const std::string& line : report.left) log_.warn("not-cleaned", {{"job", job.id}, {"reason", line}});
}

void JobRunner::shut_down(milliseconds grace, std::function<void()> stopped) {
  stopping_ = true;
  stopped_ = std::move(stopped);
  if (running_.empty()) {
    end_stop();
    return;
  }
  grace_timer_.expires_after(grace);
  grace_timer_.async_wait([this](boost::system::error_code error) {
    if (error || killed_) return;
    for (auto& [id, run] : running_) run.work->stop(kAbandon);
    end_stop_after(kAbandon + kLeave);
  });
}

void JobRunner::kill() {
  if (std::exchange(killed_, true)) return;
  for (auto& [id, run] : running_) run.work->stop(milliseconds(0));
  end_stop_after(kLeave);
}

// A killed process that waits for a hanging device or file server ends only when the device or server answers. Its job
// stays running in the state file, and waits at the next start of the service.
void JobRunner::end_stop_after(milliseconds patience) {
  grace_timer_.expires_after(patience);
  grace_timer_.async_wait([this](boost::system::error_code error) {
    if (error || !stopped_) return;
    for (const auto& [id, run] : running_) {
      log_.warn("left-running", {{"job", id}, {"source", run.job.source}, {"step", run.work->step()}});
    }
    end_stop();
  });
}

void JobRunner::end_stop() {
  grace_timer_.cancel();
  if (stopped_) boost::asio::post(io_, std::exchange(stopped_, nullptr));
}

}  // namespace weir
