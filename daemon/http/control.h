// What the outside may ask of the running service: the interface between the
// HTTP side (api.h) and whoever does the work (service_control.h). Every call is made
// on the io_context's thread and must answer at once: look, decide, return;
// nothing here waits for a conversion. A call that cannot do its work throws
// Error, which the client sees as status 500 with the message.
//
// Times are seconds since 1970-01-01 UTC; sizes are bytes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/jobs/seconds_histogram.h"
#include "daemon/store/job_order.h"
#include "daemon/store/job_state.h"

namespace weir {

/// One .nvdb file that a job made.
struct OutputView {
  std::string path;
  std::uint64_t bytes = 0;
  double rate = 0;                ///< float32 bytes of the volume / bytes of the file
  std::optional<double> psnr_db;  ///< none where lossless, or lossless over valid voxels (max_error 0)
  bool lossless = false;
  bool thumbnail = false;             ///< Control::thumbnail_path has one
  std::optional<double> max_error{};  ///< the largest absolute one; none, as for the next, where an older weir wrote it
  std::optional<double> min{};        ///< of the source's finite values
  std::optional<double> max{};
};

struct JobView {
  std::int64_t id = 0;
  std::string watch;   ///< WatchView::label
  std::string source;  ///< absolute path
  JobState state = JobState::discovered;
  std::uint64_t source_bytes = 0;  ///< Job::source_bytes()
  int attempts = 0;
  double discovered_at = 0;
  double changed_at = 0;                  ///< when it came into `state`, or got its thumbnails
  std::optional<double> next_attempt_at;  ///< waiting after a failed attempt
  std::string reason;                     ///< why it is where it is, or is not taken yet, one line; else empty
  std::optional<int> exit_code;           ///< of the last attempt, where it ended with one
  std::optional<double> seconds;          ///< of the last attempt
  std::uint64_t bytes_read = 0;
  std::uint64_t bytes_written = 0;
  std::uint64_t peak_rss_bytes = 0;
  std::vector<OutputView> outputs;
  std::string log_tail;  ///< last lines of the last attempt; filled by Control::job alone
};

/// Which jobs, and which part of them.
struct JobQuery {
  std::optional<JobState> state;
  std::optional<std::string> watch;  ///< JobView::watch, exactly
  std::size_t offset = 0;
  std::size_t limit = 100;
  std::string text{};               ///< a part of the source's path or of the reason, letter case aside; empty: any
  std::string problem{};            ///< ProblemView::key; empty: any
  std::optional<JobOrder> order{};  ///< none: as JobPage says
};

struct JobPage {
  std::uint64_t total = 0;    ///< jobs that match, on all pages
  std::vector<JobView> jobs;  ///< the latest change first; waiting ones in the order they will be run
};

/// Failed and quarantined jobs whose reasons are the same but for numbers and their own paths.
struct ProblemView {
  std::string key;
  std::uint64_t count = 0;
  JobView newest;
};

struct ProblemPage {
  std::uint64_t total = 0;          ///< failed and quarantined jobs
  std::vector<ProblemView> groups;  ///< the newest first
};

struct RunningView {
  std::int64_t id = 0;
  std::string watch;
  std::string source;
  std::string step;                ///< "convert", "verify", "render"
  std::optional<double> fraction;  ///< of that step, 0..1; none before the first report
  double seconds = 0;              ///< since the job was started
  std::uint64_t source_bytes = 0;
  std::uint64_t rss_bytes = 0;  ///< of the child process now
  std::string stall{};          ///< why it stands still; empty: it does not
};

struct WatchView {
  std::string label;  ///< unique; what the configuration calls it, else its directory
  std::string directory;
  std::string output;
  std::string method;  ///< "inotify" or "poll"
  bool up = false;     ///< the directory is there and being watched
  std::string reason;  ///< why it is not up; else empty
  std::array<std::uint64_t, kJobStates> jobs{};
  std::uint64_t overflows = 0;         ///< of the inotify queue since start
  std::optional<JobView> last_done{};  ///< the newest result
  std::uint64_t waiting_bytes = 0;     ///< of the sources of its waiting jobs
  double done_per_min = 0;             ///< conversions, over the last ten minutes
};

/// A file system that outputs are written to.
struct DiskView {
  std::string path;                      ///< where it is mounted
  std::vector<std::string> directories;  ///< outputs' that lie on it
  std::uint64_t free_bytes = 0;
  std::uint64_t total_bytes = 0;
  double written_bytes_per_s = 0;    ///< of outputs, over the last ten minutes
  std::optional<double> fills_in_s;  ///< at that rate; none: not within a year
  std::string held;                  ///< why jobs with outputs on it wait, or that it does not answer; else empty
};

/// Over the last ten minutes, or since the start where that is shorter.
struct RateView {
  double per_min = 0;      ///< files
  double bytes_per_s = 0;  ///< of sources
};

enum class ViewerState {
  off,       ///< the configuration wants none
  none,      ///< none runs
  starting,  ///< the process runs and does not answer yet
  ready,
  failed  ///< it did not start, or has ended by itself
};
inline constexpr std::array<std::string_view, 5> kViewerStateNames{"off", "none", "starting", "ready", "failed"};

/// The viewer of outputs, `weir view` behind /view/.
struct ViewerView {
  ViewerState state = ViewerState::none;
  std::string reason;              ///< why it is off, or failed; else empty
  std::string file;                ///< the output that it was started with; else empty
  std::uint64_t connections = 0;   ///< of browsers
  std::uint64_t sockets = 0;       ///< of those, pages that are open
  std::uint64_t rss_bytes = 0;     ///< of its process now
  std::uint64_t memory_bytes = 0;  ///< that it may take; 0: off
};

struct StatusView {
  std::string version;
  std::string config;      ///< path
  std::string state;       ///< "running", "paused" (nothing starts), "stopping"
  std::string reason;      ///< why it is paused; while it runs, which full disks jobs wait for; else empty
  double started_at = 0;   ///< of this process
  double queue_age_s = 0;  ///< since the oldest waiting job was complete; 0 where none waits
  double bytes_per_s = 0;  ///< source bytes converted, over the last minute
  std::uint64_t jobs_at_once = 1;
  std::array<std::uint64_t, kJobStates> jobs{};  ///< by state, all watches
  std::uint64_t done_total = 0;                  ///< conversions finished since start
  std::uint64_t bytes_in_total = 0;              ///< source bytes converted since start
  std::uint64_t bytes_out_total = 0;             ///< output bytes written since start
  RateView arrived;                              ///< complete files, those left out that were there at the start
  RateView converted;
  std::uint64_t waiting_bytes = 0;        ///< of the sources of waiting jobs
  std::optional<double> queue_ends_in_s;  ///< at present rates; 0: nothing waits; none: not in sight
  std::vector<DiskView> disks;
  std::vector<RunningView> running;
  std::vector<WatchView> watches;  ///< in the order of the configuration
  ViewerView viewer;
};

/// What /metrics needs beyond StatusView. Counters are since start.
struct MetricsView {
  SecondsHistogram conversion_seconds;          ///< of jobs that ended in done
  std::map<std::string, std::uint64_t> errors;  ///< failed attempts by kind: "input", "io", "budget", "killed", ...
  std::uint64_t reloads = 0;                    ///< of the configuration
  std::uint64_t rejected_reloads = 0;           ///< a new configuration was bad, the old one stayed
  std::uint64_t log_lines_lost = 0;             ///< that could not be written
};

struct Readiness {
  bool ready = false;
  std::string reason;  ///< why not: the watch that is down, the state file that cannot be written
};

/// What became of a request to change one job.
enum class JobChange {
  made,
  no_such_job,
  wrong_state,  ///< retry of one that is waiting or running; cancel of one that is over
  no_source     ///< retry of one that is done and whose source is gone
};

/// What became of a request for a viewer.
enum class ViewChange {
  made,  ///< it runs or is being started, or could not be: ViewerView says so
  no_such_job,
  no_such_output,
  wrong_state,  ///< the job is not done
  off,
  taken  ///< somebody looks at another series
};

class Control {
 public:
  virtual ~Control() = default;

  virtual JobPage jobs(const JobQuery& query) = 0;
  virtual ProblemPage problems(std::size_t limit) = 0;
  /// With its log tail.
  virtual std::optional<JobView> job(std::int64_t id) = 0;
  /// A failed, quarantined, cancelled or done job waits again, as if it were new; one that waits out a delay
  /// after a failed attempt waits no longer.
  /// `force`: it is converted even where its outputs are there and of this source.
  virtual JobChange retry(std::int64_t id, bool force) = 0;
  /// retry() of every failed and quarantined job, or of those of one problem (ProblemView::key). Those there are, of
  /// which the first few are retried when this returns and the others soon after; throws where the first cannot be.
  virtual std::uint64_t retry_all_failed(const std::string& problem) = 0;
  /// A discovered or waiting job becomes cancelled, a running one is stopped first.
  virtual JobChange cancel(std::int64_t id) = 0;
  /// Starts no more jobs until resume(); running ones go on. Both may be asked for twice.
  virtual void pause() = 0;
  virtual void resume() = 0;

  virtual StatusView status() = 0;
  virtual MetricsView metrics() = 0;
  virtual Readiness readiness() = 0;
  /// The PNG of a job's output, by its place in JobView::outputs; none where there is no such thumbnail. The path
  /// comes from what the service itself recorded, never from a client.
  virtual std::optional<std::string> thumbnail_path(std::int64_t job, std::size_t output) = 0;
  virtual ViewerView viewer() = 0;
  /// Has a viewer of the series of a done job's output, by its place in JobView::outputs. `force`: also where somebody
  /// looks at another series, which ends then.
  virtual ViewChange view(std::int64_t job, std::size_t output, bool force) = 0;
};

}  // namespace weir
