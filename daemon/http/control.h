// The requests that clients may make to the running service: the interface between the HTTP side (api.h) and the part
// that does the work (service_control.h). Every call is made on the io_context's thread and must return at once; no
// call waits for a conversion. A call that cannot do its work throws Error, and the client gets status 500 with the
// message.
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
  std::optional<double> psnr_db;  ///< none if lossless, or if lossless over valid voxels (max_error 0)
  bool lossless = false;
  bool thumbnail = false;             ///< Control::thumbnail_path has one
  std::optional<double> max_error{};  ///< the largest absolute error; none, like min and max, from an older weir
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
  double changed_at = 0;                  ///< when it came into `state` or got its thumbnails
  std::optional<double> next_attempt_at;  ///< for a job that waits after a failed attempt
  std::string reason;             ///< why the job is in its state or is not taken yet, one line; otherwise empty
  std::optional<int> exit_code;   ///< of the last attempt if it ended with an exit code
  std::optional<double> seconds;  ///< of the last attempt
  std::uint64_t bytes_read = 0;
  std::uint64_t bytes_written = 0;
  std::uint64_t peak_rss_bytes = 0;
  std::vector<OutputView> outputs;
  std::string log_tail;  ///< last lines of the last attempt; only Control::job fills it
};

/// Selects jobs, and a part of the list.
struct JobQuery {
  std::optional<JobState> state;
  std::optional<std::string> watch;  ///< JobView::watch, must be equal
  std::size_t offset = 0;
  std::size_t limit = 100;
  std::string text{};               ///< a part of the source's path or of the reason, in either letter case; empty: any
  std::string problem{};            ///< ProblemView::key; empty: any
  std::optional<JobOrder> order{};  ///< none: the order that JobPage describes
};

struct JobPage {
  std::uint64_t total = 0;    ///< number of matching jobs on all pages
  std::vector<JobView> jobs;  ///< the latest change first; with state = waiting, the longest in the queue
};

/// Failed and quarantined jobs with equal reasons, apart from numbers and their own paths.
struct ProblemView {
  std::string key;
  std::uint64_t count = 0;
  JobView newest;
};

struct ProblemPage {
  std::uint64_t total = 0;          ///< number of failed and quarantined jobs
  std::vector<ProblemView> groups;  ///< the newest first
};

struct RunningView {
  std::int64_t id = 0;
  std::string watch;
  std::string source;
  std::string step;                ///< "convert", "verify", "render"
  std::optional<double> fraction;  ///< progress of this step, 0..1; none before the first report
  double seconds = 0;              ///< since the job was started
  std::uint64_t source_bytes = 0;
  std::uint64_t rss_bytes = 0;  ///< of the child process now
  std::string stall{};          ///< why the job makes no progress; empty if it does
};

struct WatchView {
  std::string label;  ///< unique; the name in the configuration, otherwise the directory
  std::string directory;
  std::string output;
  std::string method;  ///< "inotify" or "poll"
  bool up = false;     ///< the directory is there and being watched
  std::string reason;  ///< why the watch is not up; otherwise empty
  std::array<std::uint64_t, kJobStates> jobs{};
  std::uint64_t overflows = 0;         ///< of the inotify queue since start
  std::optional<JobView> last_done{};  ///< the newest result
  std::uint64_t waiting_bytes = 0;     ///< of the sources of its waiting jobs
  double done_per_min = 0;             ///< conversions, over the last ten minutes
  /// Whether a file system is mounted at the watch's `output_mount`; none if it has no such key.
  std::optional<bool> output_mounted{};
};

/// A file system that outputs are written to.
struct DiskView {
  std::string path;                      ///< where it is mounted
  std::vector<std::string> directories;  ///< output directories on it
  std::uint64_t free_bytes = 0;
  std::uint64_t total_bytes = 0;
  double written_bytes_per_s = 0;    ///< of outputs, over the last ten minutes
  std::optional<double> fills_in_s;  ///< at this rate; none: not within a year
  std::string held;  ///< why jobs with outputs on it wait, or that the disk does not answer; otherwise empty
};

/// Averages over the last ten minutes, or since the start if that is shorter.
struct RateView {
  double per_min = 0;      ///< files
  double bytes_per_s = 0;  ///< of sources
};

enum class ViewerState {
  off,       ///< the configuration disables the viewer
  none,      ///< no viewer runs
  starting,  ///< the process runs and does not answer yet
  ready,
  failed  ///< the process did not start, or ended by itself
};
inline constexpr std::array<std::string_view, 5> kViewerStateNames{"off", "none", "starting", "ready", "failed"};

/// The viewer of outputs, `weir view` behind /view/.
struct ViewerView {
  ViewerState state = ViewerState::none;
  std::string reason;              ///< why it is off or failed; otherwise empty
  std::string file;                ///< the output that it was started with; otherwise empty
  std::uint64_t connections = 0;   ///< connections of browsers
  std::uint64_t sockets = 0;       ///< connections that are open pages
  std::uint64_t rss_bytes = 0;     ///< of its process
  std::uint64_t memory_bytes = 0;  ///< that it may take; 0: the viewer is off
};

struct StatusView {
  std::string version;
  std::string config;      ///< path
  std::string state;       ///< "running", "paused" (no job starts), "stopping"
  std::string reason;      ///< why the service is paused; while it runs, the disks that jobs wait for; otherwise empty
  double started_at = 0;   ///< when this process started
  double queue_age_s = 0;  ///< since the oldest waiting job was complete; 0 if no job waits
  double bytes_per_s = 0;  ///< source bytes converted, over the last minute
  std::uint64_t jobs_at_once = 1;
  std::array<std::uint64_t, kJobStates> jobs{};  ///< by state, all watches
  std::uint64_t done_total = 0;                  ///< conversions finished since start
  std::uint64_t bytes_in_total = 0;              ///< source bytes converted since start
  std::uint64_t bytes_out_total = 0;             ///< output bytes written since start
  RateView arrived;                              ///< complete files, without those that were there at the start
  RateView converted;
  std::uint64_t waiting_bytes = 0;        ///< of the sources of waiting jobs
  std::optional<double> queue_ends_in_s;  ///< at present rates; 0: nothing waits; none: no end in sight
  std::vector<DiskView> disks;
  std::vector<RunningView> running;
  std::vector<WatchView> watches;  ///< in the order of the configuration
  ViewerView viewer;
};

/// Figures of /metrics that StatusView lacks. Counters are since the start.
struct MetricsView {
  SecondsHistogram conversion_seconds;          ///< of jobs that ended in done
  std::map<std::string, std::uint64_t> errors;  ///< failed attempts by kind: "input", "io", "budget", "killed", ...
  std::uint64_t reloads = 0;                    ///< of the configuration
  std::uint64_t rejected_reloads = 0;           ///< a new configuration was invalid, and the old one stayed
  std::uint64_t log_lines_lost = 0;             ///< lines that could not be written
};

struct Readiness {
  bool ready = false;
  std::string reason;  ///< why not: a watch is down, or the state file cannot be written
};

/// The result of a request to change one job.
enum class JobChange {
  made,
  no_such_job,
  wrong_state,  ///< retry of a waiting or running job; cancel of a job that is over
  no_source     ///< retry of a done job whose source is gone
};

/// The result of a request for a viewer.
enum class ViewChange {
  made,  ///< the viewer runs or is starting, or has failed to start: see ViewerView
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
  /// Returns the job with its log tail.
  virtual std::optional<JobView> job(std::int64_t id) = 0;
  /// Makes a failed, quarantined, cancelled or done job wait again as if it were new. A job that waits after a failed
  /// attempt becomes due at once. `force`: the job is converted even if its outputs exist and are of this source.
  virtual JobChange retry(std::int64_t id, bool force) = 0;
  /// Calls retry() for every failed and quarantined job, or for those of one problem (ProblemView::key). Returns the
  /// number of these jobs. The first few are retried before the call returns, the others soon after. Throws if the
  /// first jobs cannot be retried.
  virtual std::uint64_t retry_all_failed(const std::string& problem) = 0;
  /// Cancels a discovered or waiting job; a running job is stopped first.
  virtual JobChange cancel(std::int64_t id) = 0;
  /// Starts no more jobs until resume(); running jobs go on. Both calls may be repeated.
  virtual void pause() = 0;
  virtual void resume() = 0;

  virtual StatusView status() = 0;
  virtual MetricsView metrics() = 0;
  virtual Readiness readiness() = 0;
  /// Returns the path of the PNG of a job's output, given by its index in JobView::outputs; none if there is no
  /// thumbnail. The path comes from the service's own records, never from a client.
  virtual std::optional<std::string> thumbnail_path(std::int64_t job, std::size_t output) = 0;
  virtual ViewerView viewer() = 0;
  /// Opens a viewer of the series of a done job's output, given by its index in JobView::outputs. `force`: also if
  /// somebody looks at another series, whose viewer then ends.
  virtual ViewChange view(std::int64_t job, std::size_t output, bool force) = 0;
};

}  // namespace weir
