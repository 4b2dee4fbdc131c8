#include "daemon/http/metrics.h"

#include <cmath>
#include <initializer_list>
#include <string_view>
#include <utility>

#include "format/base/exact_text.h"
#include "format/base/text.h"

namespace weir {
namespace {

std::string number(std::uint64_t value) { return cat(value); }

std::string number(double value) {
  if (std::isnan(value)) return "NaN";
  if (std::isinf(value)) return value > 0 ? "+Inf" : "-Inf";
  return exact_text(value);
}

std::string escaped(std::string_view label) {
  std::string result;
  for (const char c : label) {
    if (c == '\n') {
      result += "\\n";
    } else {
      if (c == '\\' || c == '"') result += '\\';
      result += c;
    }
  }
  return result;
}

using Labels = std::initializer_list<std::pair<std::string_view, std::string_view>>;

// Writes metric families one after the other, each with its samples.
class MetricsWriter {
 public:
  void family(std::string_view name, std::string_view type, std::string_view help) {
    name_ = cat("weir_", name);
    text_ += cat("# HELP ", name_, ' ', help, "\n# TYPE ", name_, ' ', type, '\n');
  }
  template <typename Number>
  void sample(Labels labels, Number value, std::string_view suffix = "") {
    text_ += cat(name_, suffix);
    char separator = '{';
    for (const auto& [label, content] : labels) {
      text_ += cat(separator, label, "=\"", escaped(content), '"');
      separator = ',';
    }
    if (labels.size() > 0) text_ += '}';
    text_ += cat(' ', number(value), '\n');
  }
  /// Writes a family of one sample.
  template <typename Number>
  void single(std::string_view name, std::string_view type, std::string_view help, Number value) {
    family(name, type, help);
    sample({}, value);
  }
  std::string text() && { return std::move(text_); }

 private:
  std::string name_;
  std::string text_;
};

std::uint64_t flag(bool value) { return value ? 1 : 0; }

void write_service(MetricsWriter& out, const StatusView& status, const MetricsView& metrics) {
  out.family("build_info", "gauge", "The version that runs; always 1.");
  out.sample({{"version", status.version}}, std::uint64_t{1});
  out.single("start_time_seconds", "gauge", "When the service was started, Unix time.", status.started_at);
  out.single("paused", "gauge",
             "1 while no new conversion is started: asked for, the state file cannot be written, or no output's disk, "
             "or not that of work_dir, has room.",
             flag(status.state == "paused"));
  out.family("config_reloads_total", "counter", "Reloads of the configuration; a rejected one changed nothing.");
  out.sample({{"result", "applied"}}, metrics.reloads);
  out.sample({{"result", "rejected"}}, metrics.rejected_reloads);
  out.single("log_lines_lost_total", "counter", "Lines of the log that could not be written, as on a full disk.",
             metrics.log_lines_lost);
}

void write_jobs(MetricsWriter& out, const StatusView& status, const MetricsView& metrics) {
  out.family("jobs", "gauge", "Jobs by state.");
  for (std::size_t i = 0; i < kJobStates; ++i) out.sample({{"state", kJobStateNames[i]}}, status.jobs[i]);
  out.single("queue_age_seconds", "gauge", "How long the oldest waiting job has waited; 0 where none waits.",
             status.queue_age_s);
  out.single("conversions_total", "counter", "Conversions that ended with verified outputs.", status.done_total);
  out.single("source_bytes_total", "counter", "Bytes of the sources converted.", status.bytes_in_total);
  out.single("output_bytes_total", "counter", "Bytes of the outputs written.", status.bytes_out_total);
  out.single("throughput_bytes_per_second", "gauge", "Source bytes converted a second, over the last minute.",
             status.bytes_per_s);
  out.family("errors_total", "counter", "Attempts that failed, by kind.");
  for (const auto& [kind, count] : metrics.errors) out.sample({{"kind", kind}}, count);

  const SecondsHistogram& durations = metrics.conversion_seconds;
  out.family("conversion_seconds", "histogram", "From a conversion's start to its verified outputs.");
  for (std::size_t i = 0; i < SecondsHistogram::kBounds.size(); ++i) {
    out.sample({{"le", number(SecondsHistogram::kBounds[i])}}, durations.at_most(i), "_bucket");
  }
  out.sample({{"le", "+Inf"}}, durations.count(), "_bucket");
  out.sample({}, durations.sum(), "_sum");
  out.sample({}, durations.count(), "_count");
}

void write_watches(MetricsWriter& out, const StatusView& status) {
  out.family("watch_up", "gauge", "1 while the directory is there and watched.");
  for (const WatchView& watch : status.watches) {
    out.sample({{"watch", watch.label}, {"method", watch.method}}, flag(watch.up));
  }
  out.family("watch_output_mounted", "gauge", "1 while a file system is mounted at the watch's output_mount.");
  for (const WatchView& watch : status.watches) {
    if (watch.output_mounted) out.sample({{"watch", watch.label}}, flag(*watch.output_mounted));
  }
  out.family("watch_jobs", "gauge", "Jobs by watched directory and state.");
  for (const WatchView& watch : status.watches) {
    for (std::size_t i = 0; i < kJobStates; ++i) {
      out.sample({{"watch", watch.label}, {"state", kJobStateNames[i]}}, watch.jobs[i]);
    }
  }
  out.family("inotify_overflows_total", "counter", "Event queues that overflowed; each was followed by a rescan.");
  for (const WatchView& watch : status.watches) out.sample({{"watch", watch.label}}, watch.overflows);
}

// Calls `sample(watch, job, output)` for each watch's newest result: the last output of its last job.
template <typename Sample>
void for_last_results(const StatusView& status, const Sample& sample) {
  for (const WatchView& watch : status.watches) {
    if (watch.last_done && !watch.last_done->outputs.empty()) {
      sample(watch.label, *watch.last_done, watch.last_done->outputs.back());
    }
  }
}

void write_last_results(MetricsWriter& out, const StatusView& status) {
  using Watch = const std::string&;
  using Job = const JobView&;
  using Output = const OutputView&;
  out.family("last_result_timestamp_seconds", "gauge", "When the newest result of a watch was done, Unix time.");
  for_last_results(status, [&](Watch watch, Job job, Output) { out.sample({{"watch", watch}}, job.changed_at); });
  out.family("last_result_bytes", "gauge", "Size of the newest result of a watch.");
  for_last_results(status, [&](Watch watch, Job, Output output) { out.sample({{"watch", watch}}, output.bytes); });
  out.family("last_result_rate", "gauge", "float32 bytes of the volume / bytes of the file, of the newest result.");
  for_last_results(status, [&](Watch watch, Job, Output output) { out.sample({{"watch", watch}}, output.rate); });
  out.family("last_result_lossless", "gauge", "1 where the newest result is equal to its source.");
  for_last_results(status, [&](Watch watch, Job, Output output) {
    out.sample({{"watch", watch}}, flag(output.lossless));
  });
  out.family("last_result_psnr_db", "gauge", "PSNR of the newest result; +Inf where it is lossless.");
  for_last_results(status, [&](Watch watch, Job, Output output) {
    if (output.lossless) {
      out.sample({{"watch", watch}}, HUGE_VAL);
    } else if (output.psnr_db) {
      out.sample({{"watch", watch}}, *output.psnr_db);
    }
  });
}

void write_disks(MetricsWriter& out, const StatusView& status) {
  out.family("output_disk_free_bytes", "gauge", "Room that is left for outputs, by file system.");
  for (const DiskView& disk : status.disks) out.sample({{"disk", disk.path}}, disk.free_bytes);
  out.family("output_disk_size_bytes", "gauge", "Size of the file systems of outputs.");
  for (const DiskView& disk : status.disks) out.sample({{"disk", disk.path}}, disk.total_bytes);
  out.family("disk_held", "gauge", "1 while jobs wait for room on that file system of outputs, or it does not answer.");
  for (const DiskView& disk : status.disks) out.sample({{"disk", disk.path}}, flag(!disk.held.empty()));
}

void write_process(MetricsWriter& out, const StatusView& status, const ProcessUsage& usage) {
  out.single("resident_memory_bytes", "gauge", "Resident memory of the service, conversions not counted.",
             usage.resident_bytes);
  std::uint64_t conversions = 0;
  for (const RunningView& running : status.running) conversions += running.rss_bytes;
  out.single("conversions_resident_memory_bytes", "gauge", "Resident memory of the running conversions.", conversions);
  out.single("open_descriptors", "gauge", "File descriptors the service holds.", usage.open_descriptors);
  out.single("threads", "gauge", "Threads of the service.", usage.threads);
}

}  // namespace

std::string metrics_text(const StatusView& status, const MetricsView& metrics, const ProcessUsage& usage) {
  MetricsWriter out;
  write_service(out, status, metrics);
  write_jobs(out, status, metrics);
  write_watches(out, status);
  write_last_results(out, status);
  write_disks(out, status);
  write_process(out, status, usage);
  return std::move(out).text();
}

}  // namespace weir
