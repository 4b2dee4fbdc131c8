// One job while it runs: convert, verify each output, report that it is done, then a thumbnail of each. Every step is a
// process of its own (`weir convert --skip-done`, `weir verify`, `weir render`), so that a broken file, a fault of a
// library or a lack of memory ends that process and not the daemon; which bytes come out is decided there, as on the
// command line.
#pragma once

#include <boost/asio/io_context.hpp>
#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/jobs/conversion_task.h"
#include "daemon/jobs/worker_process.h"
#include "daemon/store/job.h"

namespace weir {

/// How a run ended.
enum class TaskEnd {
  done,
  failed,          ///< by itself: JobResult::exit_code and reason say why
  disk_full,       ///< a file system is full; source and options are fine. For a done job: a thumbnail found no room
  output_busy,     ///< another process writes the output
  source_changed,  ///< the source, or a file that it names, was rewritten during the run; the outputs are invalid
  source_gone,     ///< deleted before it was converted
  stopped          ///< as asked
};

struct TaskReport {
  TaskEnd end = TaskEnd::done;
  JobResult result;
  std::string full_directory;        ///< for disk_full: a directory on the full file system; otherwise empty
  std::uint64_t planned_bytes = 0;   ///< of the output that was to be written last; 0: not known
  bool converted = false;            ///< false where all outputs had been made before
  bool rendering = false;            ///< done, and thumbnails follow: another report comes when they are there
  std::vector<std::string> notices;  ///< what went wrong and does not matter to the result; one line each
};

class ConversionJob {
 public:
  /// Called with the result. If TaskReport::rendering is set, called once more when the thumbnails are there. The last
  /// call may destroy the job.
  using Ended = std::function<void(const TaskReport& report)>;

  /// Runs `task` on `io`. If task.outputs is not empty, only their thumbnails are rendered. `ended` is never called
  /// from within the constructor.
  ConversionJob(boost::asio::io_context& io, ConversionTask task, Ended ended);
  ConversionJob(const ConversionJob&) = delete;
  ConversionJob& operator=(const ConversionJob&) = delete;
  /// Kills what runs; `ended` is not called.
  ~ConversionJob() = default;

  /// Ends the work within `grace`, by force if need be.
  void stop(std::chrono::milliseconds grace);

  const ConversionTask& task() const { return task_; }
  std::string_view step() const { return step_; }               ///< "convert", "verify" or "render"
  std::optional<double> fraction() const { return fraction_; }  ///< of the step, 0..1; none before the first report
  double seconds() const;                                       ///< since the start
  /// Records whether the step's process is active. Must be called regularly, because stall() depends on it.
  void look();
  /// Returns why the step stands still; empty if it does not. It stands still if it announced nothing and look() saw no
  /// activity for `quiet`, or if it computed for `opening` without any announcement (a library loops in a damaged
  /// file).
  std::string stall(std::chrono::seconds quiet, std::chrono::seconds opening) const;
  std::uint64_t resident_bytes() const { return worker_ ? worker_->resident_bytes() : 0; }

 private:
  struct Output {
    JobOutput job;
    bool skipped = false;
  };

  void run(std::string_view step, std::vector<std::string> arguments, void (ConversionJob::*then)(const WorkerEnd&));
  void convert();
  void converted(const WorkerEnd& end);
  void verify_next();
  void verified(const WorkerEnd& end);
  void all_verified();
  void render_next();
  void rendered(const WorkerEnd& end);
  void fail(int exit_code, const std::string& reason);
  void end(TaskEnd how);
  void heard(std::string_view line);
  double done_of_conversion(std::string_view pass, double part) const;
  bool is_in_output_or_work_dir(const std::string& path) const;

  boost::asio::io_context& io_;
  ConversionTask task_;
  Ended ended_;
  std::chrono::steady_clock::time_point started_ = std::chrono::steady_clock::now();
  std::chrono::steady_clock::time_point heard_ = started_;  ///< when the step last announced something or was active
  std::chrono::steady_clock::time_point begun_ = started_;  ///< when the step began
  bool spoken_ = false;                                     ///< the step has announced something
  std::uint64_t activity_ = 0;                              ///< of the process, at the last look
  std::unique_ptr<WorkerProcess> worker_;
  std::string_view step_ = "convert";
  std::optional<double> fraction_;
  std::string failed_;        ///< why the conversion failed, as it announced; empty: it did not
  bool output_busy_ = false;  ///< and that was because another process writes the output
  bool stopping_ = false;
  bool reported_ = false;  ///< "done" was reported
  bool repeated_ = false;  ///< the present output's rendering was repeated
  std::vector<Output> outputs_;
  std::size_t next_ = 0;                       ///< of outputs_, in the present step
  std::optional<FileIdentity> verified_file_;  ///< identity of the output before its verification
  TaskReport report_;
  std::shared_ptr<bool> alive_ = std::make_shared<bool>(true);  ///< for what was posted and comes too late
};

/// "OUT.nvdb.png" for "OUT.nvdb".
std::string thumbnail_path_of(const std::string& output);

}  // namespace weir
