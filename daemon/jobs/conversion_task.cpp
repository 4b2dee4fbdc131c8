#include "daemon/jobs/conversion_task.h"

#include <algorithm>
#include <filesystem>

#include "daemon/watch/path_filter.h"
#include "format/base/text.h"
#include "ingest/files/input_directory.h"

namespace weir {

namespace fs = std::filesystem;

bool is_source_of(const WatchConfig& watch, const std::string& source) {
  return source.starts_with(watch.directory.ends_with('/') ? watch.directory : watch.directory + '/');
}

bool takes_source(const WatchConfig& watch, const std::string& source) {
  const std::size_t place = watch.directory.size() + (watch.directory.ends_with('/') ? 0 : 1);
  return is_source_of(watch, source) && PathFilter(watch).accepts_file(source.substr(place));
}

std::string output_directory(const WatchConfig& watch, const std::string& source) {
  const fs::path place = fs::path(named_by_head(source)).parent_path().lexically_relative(watch.directory);
  if (place.empty() || place == ".") return watch.output;
  return (fs::path(watch.output) / place).string();
}

std::string options_text(const WatchConfig& watch) {
  std::string text = cat("output=", watch.output, "/", watch.name);
  for (const std::string& option : watch.convert_options) {
    const bool same_bytes = option.starts_with("--backend=") || option.starts_with("--direct-io=");
    if (!same_bytes) text += cat(' ', option);
  }
  return text;
}

ConversionTask make_task(const std::string& program, const ServiceConfig& service, const WatchConfig& watch,
                         const Job& job) {
  const auto jobs = static_cast<std::uint64_t>(service.jobs);
  ConversionTask task;
  task.program = program;
  task.source = job.source;
  task.identity = job.identity;
  task.output = cat(output_directory(watch, job.source), '/', watch.name);
  task.convert_options = watch.convert_options;
  if (watch.follow == Follow::inside) task.within = watch.directory;
  task.memory = job_memory(service);
  // A limit stays a limit, even if a job's share is less than a byte: 0 would mean no limit.
  if (service.bandwidth != 0) task.bandwidth = std::max<std::uint64_t>(1, service.bandwidth / jobs);
  task.threads = service.threads;
  task.nice = service.nice;
  task.io_class = service.io_class;
  task.work_dir = service.work_dir;
  task.thumbnails = watch.thumbnails;
  task.again = job.forced;
  task.count_values = watch.source == AfterDone::delete_after_verify;
  return task;
}

std::optional<ConversionTask> make_rendering_task(const std::string& program, const ServiceConfig& service,
                                                  const WatchConfig& watch, const Job& job) {
  if (!watch.thumbnails) return std::nullopt;
  ConversionTask task = make_task(program, service, watch, job);
  for (const JobOutput& output : job.result.outputs) {
    std::error_code ignored;
    if (output.thumbnail.empty() && std::filesystem::exists(output.path, ignored)) task.outputs.push_back(output);
  }
  if (task.outputs.empty()) return std::nullopt;
  return task;
}

}  // namespace weir
