#include "daemon/jobs/conversion_job.h"

#include <algorithm>
#include <boost/asio/post.hpp>
#include <cerrno>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>

#include "daemon/config/watch_conflicts.h"
#include "daemon/jobs/worker_reason.h"
#include "daemon/jobs/wrong_output.h"
#include "daemon/store/file_identity.h"
#include "daemon/watch/source_identity.h"
#include "format/base/error.h"
#include "format/base/text.h"
#include "format/io/file_system.h"
#include "format/io/is_directory.h"
#include "ingest/files/file_state.h"

namespace weir {
namespace {

namespace fs = std::filesystem;

constexpr int kInput = static_cast<int>(ErrorKind::input);
constexpr int kIo = static_cast<int>(ErrorKind::io);

// Of what a full file system refused: a file there, or a directory.
std::string directory_at(const std::string& path) {
  return is_directory(path) ? path : fs::path(path).parent_path().string();
}

// The nearest one there is: `directory` may not have been made.
std::string existing_directory(fs::path directory) {
  while (!is_directory(directory.string()) && directory != directory.parent_path()) directory = directory.parent_path();
  return directory.string();
}

// The source's own identity says nothing of the planes of a stack and of the files that a header names.
bool says_changed(const std::string& reason) {
  return reason.ends_with(kConvertAgain) && reason.find(kChangedWhileRead) != std::string::npos;
}

// What stands at `place`; none where that is no number.
std::optional<double> number_of(const nlohmann::json& json, const char* place) {
  const nlohmann::json::json_pointer pointer(place);
  if (!json.contains(pointer) || !json[pointer].is_number()) return std::nullopt;
  return json[pointer].get<double>();
}

// Whether the picture was made after the volume got its name.
bool newer(const std::string& thumbnail, const std::string& volume) {
  std::error_code error;
  const auto made = fs::last_write_time(thumbnail, error);
  if (error) return false;
  const auto from = fs::last_write_time(volume, error);
  return !error && made >= from;
}

}  // namespace

std::string thumbnail_path_of(const std::string& output) { return output + ".png"; }

ConversionJob::ConversionJob(boost::asio::io_context& io, ConversionTask task, Ended ended)
    : io_(io), task_(std::move(task)), ended_(std::move(ended)) {
  if (task_.outputs.empty()) {
    convert();
    return;
  }
  reported_ = true;
  for (const JobOutput& output : task_.outputs) outputs_.push_back({output, true});
  render_next();
}

double ConversionJob::seconds() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - started_).count();
}

void ConversionJob::look() {
  if (worker_ == nullptr) return;
  const std::uint64_t activity = worker_->activity();
  if (std::exchange(activity_, activity) != activity) heard_ = std::chrono::steady_clock::now();
}

std::string ConversionJob::stall(std::chrono::seconds quiet, std::chrono::seconds opening) const {
  const auto now = std::chrono::steady_clock::now();
  const auto passed = now - heard_;
  if (worker_ == nullptr) return {};
  if (passed < quiet) {
    if (spoken_ || now - begun_ < opening) return {};
    return cat(step_, " computes for ", std::chrono::duration_cast<std::chrono::seconds>(now - begun_).count(),
               " s and has not begun to read values: the file may be damaged, cancel the job to end it");
  }
  const char state = worker_->process_state();
  const char* const why = state == 'T'   ? "it was stopped by a signal; SIGCONT lets it go on"
                          : state == 'D' ? "it waits for a device or a file server"
                                         : "cancel the job to end it";
  return cat("nothing done by ", step_, " for ", std::chrono::duration_cast<std::chrono::seconds>(passed).count(),
             " s: ", why);
}

void ConversionJob::stop(std::chrono::milliseconds grace) {
  stopping_ = true;
  if (worker_) worker_->stop(grace);
}

void ConversionJob::run(std::string_view step, std::vector<std::string> arguments,
                        void (ConversionJob::*then)(const WorkerEnd&)) {
  if (stopping_) {  // it came when the step before had just ended
    end(TaskEnd::stopped);
    return;
  }
  step_ = step;
  begun_ = heard_ = std::chrono::steady_clock::now();
  spoken_ = false;
  fraction_.reset();
  WorkerCommand command{task_.program, {"weir", std::string(step)}, task_.nice, task_.io_class};
  for (std::string& argument : arguments) command.arguments.push_back(std::move(argument));
  command.arguments.insert(command.arguments.end(), {"--progress=never", "--log-level=info"});
  command.arguments.push_back(cat("--progress-fd=", kAnnounceDescriptor));
  try {
    worker_ = std::make_unique<WorkerProcess>(
        io_, command, [this](std::string_view line) { heard(line); },
        [this, then](const WorkerEnd& end) {
          worker_.reset();
          report_.result.log_tail += end.log;
          (this->*then)(end);
        });
  } catch (const Error& error) {
    fail(kIo, error.what());
  }
}

void ConversionJob::convert() {
  std::error_code error;
  const fs::path directory = fs::path(task_.output).parent_path();
  fs::create_directories(directory, error);
  if (error) {
    Message reason = cat(directory.string(), ": make the directory: ", error.message());
    if (is_disk_full(error.value())) {
      report_.full_directory = existing_directory(directory);
      reason += disk_full_remedy();
    }
    fail(kIo, reason.worded(key_wording));
    return;
  }
  std::vector<std::string> arguments{task_.source,    cat("--output=", task_.output), "--skip-done",
                                     "--brief-names", cat("--memory=", task_.memory), cat("--threads=", task_.threads)};
  if (task_.again) arguments.emplace_back("--again");
  if (task_.count_values) arguments.emplace_back("--count-values");
  if (task_.bandwidth != 0) arguments.push_back(cat("--bandwidth=", task_.bandwidth));
  if (!task_.within.empty()) arguments.push_back(cat("--within=", task_.within));
  if (!task_.work_dir.empty()) arguments.push_back(cat("--work-dir=", task_.work_dir));
  arguments.insert(arguments.end(), task_.convert_options.begin(), task_.convert_options.end());
  run("convert", std::move(arguments), &ConversionJob::converted);
}

void ConversionJob::heard(std::string_view line) {
  heard_ = std::chrono::steady_clock::now();
  spoken_ = true;
  const nlohmann::json told = nlohmann::json::parse(line, nullptr, false);
  if (!told.is_object()) return;
  if (told.contains("output")) {
    Output output;
    output.job.path = told.value("output", "");
    output.job.bytes = told.value("bytes", std::uint64_t{0});
    output.job.rate = told.value("rate", 0.0);
    output.job.psnr_db = number_of(told, "/psnr_db");
    output.job.max_error = number_of(told, "/max_error");
    const bool everywhere = told.value("lossless", true);
    if (!everywhere && !output.job.psnr_db && output.job.max_error == 0.0) output.job.psnr_db = HUGE_VAL;
    output.job.min = number_of(told, "/value_range/0");
    output.job.max = number_of(told, "/value_range/1");
    output.skipped = told.value("skipped", false);
    JobResult& result = report_.result;
    result.source_bytes = std::max(result.source_bytes, told.value("source_bytes", std::uint64_t{0}));
    result.bytes_read += told.value("bytes_read", std::uint64_t{0});
    result.peak_rss_bytes = std::max(result.peak_rss_bytes, told.value("peak_rss_bytes", std::uint64_t{0}));
    if (!output.skipped) result.bytes_written += output.job.bytes;
    report_.converted = report_.converted || !output.skipped;
    outputs_.push_back(std::move(output));
    return;
  }
  if (told.contains("failed")) {
    failed_ = told.value("failed", "");
    const int error = told.value("errno", 0);
    const std::string path = told.value("path", task_.output);
    if (is_disk_full(error)) report_.full_directory = directory_at(path);
    output_busy_ = error == EWOULDBLOCK && is_in_output_or_work_dir(path);
    return;
  }
  if (told.contains("planned")) {
    report_.planned_bytes = told.value("planned", std::uint64_t{0});
    return;
  }
  const auto total = told.value("total", 0.0);
  if (total <= 0) return;
  const double part = told.value("done", 0.0) / total;
  fraction_ = step_ == "convert" ? done_of_conversion(told.value("pass", ""), part) : part;
}

// A source whose server does not answer fails with the same number.
bool ConversionJob::is_in_output_or_work_dir(const std::string& path) const {
  return is_within(path, fs::path(task_.output).parent_path().string()) ||
         (!task_.work_dir.empty() && is_within(path, task_.work_dir));
}

// Passes of about the same length: two, or with --certify three.
double ConversionJob::done_of_conversion(std::string_view pass, double part) const {
  const bool certifies = std::ranges::any_of(task_.convert_options,
                                             [](const std::string& option) { return option == "--certify=gradient"; });
  const double before = pass == "certify" ? 2 : pass == "encode" ? 1 : 0;
  return (before + part) / (certifies ? 3 : 2);
}

void ConversionJob::converted(const WorkerEnd& end) {
  if (end.exit_code == 0 && outputs_.empty()) {
    fail(static_cast<int>(ErrorKind::internal), "convert ended well and announced no output");
  } else if (end.exit_code != 0) {
    fail(end.exit_code, failed_.empty() ? worker_reason(step_, end) : failed_);
  } else if (const auto now = identify_source(task_.source, task_.convert_options); now && *now != task_.identity) {
    this->end(TaskEnd::source_changed);
  } else {
    next_ = 0;
    verify_next();
  }
}

void ConversionJob::verify_next() {
  if (next_ == outputs_.size()) {
    all_verified();
    return;
  }
  verified_file_ = identify(outputs_[next_].job.path);
  run("verify", {outputs_[next_].job.path}, &ConversionJob::verified);
}

void ConversionJob::verified(const WorkerEnd& end) {
  if (end.exit_code == 0) {
    ++next_;
    verify_next();
    return;
  }
  const std::string reason = worker_reason(step_, end);
  // Exit code 3 alone says that the content is wrong: a disk or a file server that fails says nothing of it.
  if (end.exit_code != kInput || stopping_) {
    fail(end.exit_code, reason);
    return;
  }
  // Not what was written: nobody may take it for a result, and the next attempt makes it anew. The fault is
  // the device's, not the source's.
  const std::unique_ptr<FileSystem> files = make_posix_file_system();
  fail(kIo, cat("verify: ", reason, "; ", remove_wrong_output(*files, outputs_[next_].job.path, verified_file_)));
}

// The result is there: a picture of it, which takes longer than a small conversion, keeps nobody waiting for it.
void ConversionJob::all_verified() {
  const auto now = identify_source(task_.source, task_.convert_options);
  if (now && *now != task_.identity) {
    end(TaskEnd::source_changed);
    return;
  }
  bool all_rendered = true;
  for (Output& output : outputs_) {
    const std::string thumbnail = thumbnail_path_of(output.job.path);
    if (task_.thumbnails && output.skipped && newer(thumbnail, output.job.path)) output.job.thumbnail = thumbnail;
    all_rendered = all_rendered && (!task_.thumbnails || !output.job.thumbnail.empty());
  }
  if (all_rendered) {
    end(TaskEnd::done);
    return;
  }
  boost::asio::post(io_, [this, alive = std::weak_ptr<bool>(alive_)] {
    if (!alive.lock()) return;
    if (stopping_) {
      end(TaskEnd::stopped);
      return;
    }
    reported_ = true;
    TaskReport report = report_;
    report.rendering = true;
    report.result.seconds = seconds();
    for (const Output& output : outputs_) report.result.outputs.push_back(output.job);
    ended_(report);
    next_ = 0;
    render_next();
  });
}

void ConversionJob::render_next() {
  while (next_ < outputs_.size() && !outputs_[next_].job.thumbnail.empty()) ++next_;
  if (next_ == outputs_.size()) {
    end(TaskEnd::done);
    return;
  }
  // As many voxels as a pixel is wide are looked up, so that their values need no interpolation.
  const std::string& output = outputs_[next_].job.path;
  run("render",
      {output, "--output=" + thumbnail_path_of(output), "--size=320x240", "--mode=dvr", "--filter=nearest", "--spp=1",
       "--backend=cpu", "--overwrite", cat("--threads=", task_.threads)},
      &ConversionJob::rendered);
}

void ConversionJob::rendered(const WorkerEnd& end) {
  if (stopping_) {
    fail(end.exit_code, worker_reason(step_, end));
    return;
  }
  JobOutput& output = outputs_[next_].job;
  const std::string reason = end.exit_code == 0 ? "" : worker_reason(step_, end);
  if (end.exit_code == kIo && says_disk_full(reason)) {  // nor will the next one find room
    report_.full_directory = existing_directory(fs::path(output.path).parent_path());
    report_.result.reason = cat("no thumbnail: ", reason);
    this->end(TaskEnd::disk_full);
    return;
  }
  // Killed, out of memory, or disturbed in its directory: what goes wrong once may go well the next time.
  if (end.exit_code != 0 && !std::exchange(repeated_, true)) {
    render_next();
    return;
  }
  repeated_ = false;
  if (end.exit_code == 0) {
    output.thumbnail = thumbnail_path_of(output.path);
  } else {
    report_.notices.push_back(cat("no thumbnail: ", reason));
  }
  ++next_;
  render_next();
}

void ConversionJob::fail(int exit_code, const std::string& reason) {
  if (reported_) {  // what is done stays so
    if (!stopping_) report_.notices.push_back(cat("no thumbnail: ", reason));
    end(stopping_ ? TaskEnd::stopped : TaskEnd::done);
    return;
  }
  report_.result.exit_code = exit_code;
  report_.result.reason = reason;
  const auto now = identify_source(task_.source, task_.convert_options);
  if (stopping_) {
    end(TaskEnd::stopped);
  } else if (is_gone(task_.source)) {
    end(TaskEnd::source_gone);
  } else if ((now && *now != task_.identity) || (exit_code == kInput && says_changed(reason))) {
    end(TaskEnd::source_changed);
  } else if (exit_code == kIo && !report_.full_directory.empty()) {
    end(TaskEnd::disk_full);
  } else if (exit_code == kIo && output_busy_) {
    end(TaskEnd::output_busy);
  } else {
    end(TaskEnd::failed);
  }
}

void ConversionJob::end(TaskEnd how) {
  report_.end = how;
  report_.result.seconds = seconds();
  for (Output& output : outputs_) report_.result.outputs.push_back(std::move(output.job));
  boost::asio::post(io_, [this, alive = std::weak_ptr<bool>(alive_)] {
    if (!alive.lock()) return;
    const Ended ended = std::exchange(ended_, nullptr);
    const TaskReport report = std::move(report_);
    ended(report);
  });
}

}  // namespace weir
