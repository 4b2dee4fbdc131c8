#include "daemon/service_control.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <utility>

#include "daemon/store/file_identity.h"
#include "format/base/text.h"

namespace weir {
namespace {

constexpr std::size_t kRetriesAtOnce = 100;
constexpr std::chrono::seconds kRetryPause{1};  // used if the state file cannot be written

double seconds_of(std::int64_t ms) { return static_cast<double>(ms) / 1000; }

JobView view_of(const Job& job) {
  JobView view;
  view.id = job.id;
  view.watch = job.watch;
  view.source = job.source;
  view.state = job.state;
  view.source_bytes = job.source_bytes();
  view.attempts = job.attempts;
  view.discovered_at = seconds_of(job.discovered_ms);
  view.changed_at = seconds_of(job.changed_ms);
  if (job.state == JobState::waiting && job.due_ms > 0) view.next_attempt_at = seconds_of(job.due_ms);
  view.reason = job.result.reason;
  if (job.finished_ms > 0) {
    view.exit_code = job.result.exit_code;
    view.seconds = job.result.seconds;
  }
  view.bytes_read = job.result.bytes_read;
  view.bytes_written = job.result.bytes_written;
  view.peak_rss_bytes = job.result.peak_rss_bytes;
  for (const JobOutput& output : job.result.outputs) {
    const bool finite = output.psnr_db && std::isfinite(*output.psnr_db);
    view.outputs.push_back({.path = output.path,
                            .bytes = output.bytes,
                            .rate = output.rate,
                            .psnr_db = finite ? output.psnr_db : std::nullopt,
                            .lossless = !output.psnr_db,
                            .thumbnail = !output.thumbnail.empty(),
                            .max_error = output.max_error,
                            .min = output.min,
                            .max = output.max});
  }
  return view;
}

}  // namespace

ServiceControl::ServiceControl(boost::asio::io_context& io, DiskTurns& turns, JobStore& store, JobRunner& runner,
                               const WatchedTrees& trees, JobViewer& viewer, const EventLog& log,
                               const ServiceState& state)
    : turns_(turns),
      store_(store),
      runner_(runner),
      trees_(trees),
      viewer_(viewer),
      log_(log),
      state_(state),
      started_at_(seconds_of(JobStore::wall_clock_ms())),
      retry_timer_(io) {}

JobPage ServiceControl::jobs(const JobQuery& query) {
  const JobFilter filter{query.state, query.watch.value_or(""), query.text, query.problem};
  JobPage page;
  page.total = store_.count(filter);
  for (const Job& job : store_.jobs(filter, query.offset, query.limit, query.order)) {
    page.jobs.push_back(view_of(job));
    if (job.state == JobState::discovered) page.jobs.back().reason = waits_for(job);
  }
  return page;
}

std::string ServiceControl::waits_for(const Job& job) const {
  for (const auto& tree : trees_) {
    if (tree->config().label == job.watch) return tree->waits_for(job.source);
  }
  return {};
}

ProblemPage ServiceControl::problems(std::size_t limit) {
  ProblemPage page;
  for (const JobState state : {JobState::failed, JobState::quarantined}) {
    page.total += store_.count({state, ""});
  }
  for (const JobProblem& problem : store_.problems(limit)) {
    page.groups.push_back({problem.key, problem.count, view_of(problem.newest)});
  }
  return page;
}

std::optional<JobView> ServiceControl::job(std::int64_t id) {
  const std::optional<Job> job = store_.job(id);
  if (!job) return std::nullopt;
  JobView view = view_of(*job);
  view.log_tail = job->result.log_tail;
  if (job->state == JobState::discovered) view.reason = waits_for(*job);
  return view;
}

JobChange ServiceControl::retry(std::int64_t id, bool force) {
  const std::optional<Job> before = store_.job(id);
  if (!before) return JobChange::no_such_job;
  // A retry would forget the job together with its results.
  if (before->state == JobState::done && is_gone(before->source)) return JobChange::no_source;
  if (!store_.retry(id, force)) return JobChange::wrong_state;
  const std::optional<Job> job = store_.job(id);
  for (const auto& tree : trees_) {
    if (tree->config().label == job->watch && job->state == JobState::discovered) tree->look_again(job->source);
  }
  runner_.wake();
  return JobChange::made;
}

// Retries a few jobs at a time: thousands at once would keep all other requests waiting.
std::uint64_t ServiceControl::retry_all_failed(const std::string& problem) {
  const std::vector<JobStore::Problem> found = store_.with_problems(problem);
  const bool idle = to_retry_.empty();
  std::set<std::int64_t> queued;
  for (const JobStore::Problem& job : to_retry_) queued.insert(job.id);
  std::copy_if(found.begin(), found.end(), std::back_inserter(to_retry_),
               [&](const JobStore::Problem& job) { return !queued.contains(job.id); });
  if (!idle) return found.size();
  try {
    retry_some();
  } catch (...) {
    to_retry_.clear();
    throw;
  }
  retry_rest(std::chrono::milliseconds(0));
  return found.size();
}

// Retries the first few jobs in one transaction.
void ServiceControl::retry_some() {
  const auto some = static_cast<std::ptrdiff_t>(std::min(to_retry_.size(), kRetriesAtOnce));
  const auto end = to_retry_.begin() + some;
  store_.together(
      [&] { std::for_each(to_retry_.begin(), end, [&](const auto& job) { store_.retry_problem(job.id); }); });
  for (const auto& tree : trees_) {
    std::for_each(to_retry_.begin(), end, [&](const JobStore::Problem& job) {
      if (tree->config().label == job.watch) tree->look_again(job.source);
    });
  }
  to_retry_.erase(to_retry_.begin(), end);
  runner_.wake();
}

void ServiceControl::retry_rest(std::chrono::milliseconds pause) {
  if (to_retry_.empty()) return;
  retry_timer_.expires_after(pause);
  retry_timer_.async_wait([this](boost::system::error_code error) {
    if (error) return;
    turns_.take([this] {
      std::chrono::milliseconds next{0};
      try {
        retry_some();
      } catch (const CorruptDatabase&) {
        throw;
      } catch (const Error&) {  // for example, the state file's disk is full, which other parts report
        next = kRetryPause;
      }
      retry_rest(next);
    });
  });
}

JobChange ServiceControl::cancel(std::int64_t id) {
  const std::optional<Job> job = store_.job(id);
  if (!job) return JobChange::no_such_job;
  if (!store_.cancel(id)) return runner_.end_rendering(*job) ? JobChange::made : JobChange::wrong_state;
  runner_.cancelled(*job);
  return JobChange::made;
}

std::vector<RunningView> ServiceControl::running() const {
  std::vector<RunningView> views;
  for (const auto& [id, run] : runner_.running()) {
    RunningView view;
    view.id = id;
    view.watch = run.job.watch;
    view.source = run.job.source;
    view.step = run.work->step();
    view.fraction = run.work->fraction();
    view.seconds = run.work->seconds();
    view.source_bytes = run.job.identity.bytes;
    view.rss_bytes = run.work->resident_bytes();
    view.stall = run.work->stall(kQuiet, kOpening);
    views.push_back(std::move(view));
  }
  return views;
}

WatchView ServiceControl::watch(const WatchedTree& tree, const std::map<std::string, JobCounts>& counts) const {
  const WatchConfig& config = tree.config();
  const WatchedTree::Status status = tree.status();
  WatchView view;
  view.label = config.label;
  view.directory = config.directory;
  view.output = config.output;
  view.method = status.method;
  view.up = status.up;
  view.reason = status.reason;
  if (!config.output_mount.empty()) view.output_mounted = runner_.is_mounted(config.output_mount);
  view.overflows = status.overflows;
  if (const auto found = counts.find(config.label); found != counts.end()) view.jobs = found->second;
  view.done_per_min = 60 * runner_.figures().converted(config.label).per_s;
  const std::vector<Job> last = store_.jobs({JobState::done, config.label}, 0, 1);
  if (!last.empty()) view.last_done = view_of(last.front());
  return view;
}

StatusView ServiceControl::status() {
  StatusView view;
  view.version = state_.version;
  view.config = state_.config;
  runner_.look_at_mounts();
  const std::string hold = runner_.hold();
  view.reason = hold.empty() ? runner_.waits_for_disks() : hold;
  view.state = state_.stopping ? "stopping" : hold.empty() ? "running" : "paused";
  view.started_at = started_at_;
  view.queue_age_s = seconds_of(store_.queue_age_ms().value_or(0));
  view.bytes_per_s = runner_.figures().bytes_per_s();
  view.jobs_at_once = static_cast<std::uint64_t>(state_.jobs);
  const std::map<std::string, JobCounts> counts = store_.counts();
  for (const auto& [label, of_watch] : counts) {
    for (std::size_t i = 0; i < kJobStates; ++i) view.jobs[i] += of_watch[i];
  }
  view.done_total = runner_.figures().totals().done;
  view.bytes_in_total = runner_.figures().totals().bytes_in;
  view.bytes_out_total = runner_.figures().totals().bytes_out;
  view.running = running();
  for (const auto& tree : trees_) view.watches.push_back(watch(*tree, counts));
  add_rates(view);
  view.disks = disks();
  view.viewer = viewer_.view();
  return view;
}

// Fills in how fast files arrive and are converted, and when the queue ends at these rates.
void ServiceControl::add_rates(StatusView& status) const {
  const std::map<std::string, std::uint64_t> waiting = store_.waiting_bytes();
  for (WatchView& watch : status.watches) {
    if (const auto at = waiting.find(watch.label); at != waiting.end()) watch.waiting_bytes = at->second;
  }
  for (const auto& [label, bytes] : waiting) status.waiting_bytes += bytes;
  RecentRate::Rates arrived;
  for (const auto& tree : trees_) {
    const RecentRate::Rates rates = tree->arrivals();
    arrived.per_s += rates.per_s;
    arrived.bytes_per_s += rates.bytes_per_s;
  }
  const RecentRate::Rates converted = runner_.figures().converted();
  status.arrived = {60 * arrived.per_s, arrived.bytes_per_s};
  status.converted = {60 * converted.per_s, converted.bytes_per_s};
  const double shrinks_by = runner_.figures().left().bytes_per_s - arrived.bytes_per_s;
  if (status.waiting_bytes == 0) {
    status.queue_ends_in_s = 0;
  } else if (shrinks_by > 0 && status.state == "running") {
    status.queue_ends_in_s = static_cast<double>(status.waiting_bytes) / shrinks_by;
  }
}

std::vector<DiskView> ServiceControl::disks() const {
  std::vector<DiskView> views;
  for (const OutputDisk& disk : runner_.disks()) {
    std::string held = runner_.hold_of(disk.room);
    if (disk.silent.count() > 0) held = cat(disk.path, " has not answered for ", disk.silent.count(), " s");
    views.push_back({.path = disk.path,
                     .directories = disk.directories,
                     .free_bytes = disk.room.free,
                     .total_bytes = disk.room.total,
                     .written_bytes_per_s = disk.written_bytes_per_s,
                     .fills_in_s = disk.fills_in_s,
                     .held = std::move(held)});
  }
  return views;
}

MetricsView ServiceControl::metrics() {
  return {.conversion_seconds = runner_.figures().totals().seconds,
          .errors = runner_.figures().totals().errors,
          .reloads = state_.reloads,
          .rejected_reloads = state_.rejected_reloads,
          .log_lines_lost = log_.lines_lost()};
}

Readiness ServiceControl::readiness() {
  if (state_.stopping) return {false, "the service is stopping"};
  if (!runner_.store_fault().empty()) return {false, runner_.store_fault()};
  for (const auto& tree : trees_) {
    const WatchedTree::Status status = tree->status();
    if (!status.up) return {false, cat(tree->config().label, ": ", status.reason)};
  }
  return {true, ""};
}

ViewChange ServiceControl::view(std::int64_t id, std::size_t output, bool force) {
  const std::optional<Job> job = store_.job(id);
  if (!job) return ViewChange::no_such_job;
  if (job->state != JobState::done) return ViewChange::wrong_state;
  if (output >= job->result.outputs.size()) return ViewChange::no_such_output;
  switch (viewer_.open(job->result.outputs[output].path, force)) {
    case JobViewer::Opened::off:
      return ViewChange::off;
    case JobViewer::Opened::taken:
      return ViewChange::taken;
    case JobViewer::Opened::made:
      break;
  }
  return ViewChange::made;
}

std::optional<std::string> ServiceControl::thumbnail_path(std::int64_t id, std::size_t output) {
  const std::optional<Job> job = store_.job(id);
  if (!job || output >= job->result.outputs.size() || job->result.outputs[output].thumbnail.empty())
    return std::nullopt;
  return job->result.outputs[output].thumbnail;
}

}  // namespace weir
