#include "daemon/http/api_json.h"

#include <nlohmann/json.hpp>

#include "daemon/store/problem_key.h"
#include "format/base/json_text.h"

namespace weir {
namespace {

template <typename T>
OrderedJson or_null(const std::optional<T>& value) {
  return value ? OrderedJson(*value) : OrderedJson();
}

OrderedJson to_json(const OutputView& output) {
  return {{"path", output.path},          {"bytes", output.bytes},
          {"rate", output.rate},          {"psnr_db", or_null(output.psnr_db)},
          {"lossless", output.lossless},  {"max_error", or_null(output.max_error)},
          {"min", or_null(output.min)},   {"max", or_null(output.max)},
          {"thumbnail", output.thumbnail}};
}

OrderedJson to_json(const RunningView& running) {
  return {{"id", running.id},
          {"watch", running.watch},
          {"source", running.source},
          {"step", running.step},
          {"fraction", or_null(running.fraction)},
          {"seconds", running.seconds},
          {"source_bytes", running.source_bytes},
          {"rss_bytes", running.rss_bytes},
          {"stall", running.stall}};
}

OrderedJson counts(const std::array<std::uint64_t, kJobStates>& jobs) {
  OrderedJson result = OrderedJson::object();
  for (std::size_t i = 0; i < kJobStates; ++i) result[std::string(kJobStateNames[i])] = jobs[i];
  return result;
}

OrderedJson to_json(const WatchView& watch) {
  return {{"label", watch.label},
          {"directory", watch.directory},
          {"output", watch.output},
          {"method", watch.method},
          {"up", watch.up},
          {"reason", watch.reason},
          {"jobs", counts(watch.jobs)},
          {"waiting_bytes", watch.waiting_bytes},
          {"done_per_min", watch.done_per_min},
          {"overflows", watch.overflows},
          {"last_done", watch.last_done ? to_json(*watch.last_done) : OrderedJson()}};
}

OrderedJson to_json(const DiskView& disk) {
  return {{"path", disk.path},
          {"directories", disk.directories},
          {"free_bytes", disk.free_bytes},
          {"total_bytes", disk.total_bytes},
          {"written_bytes_per_s", disk.written_bytes_per_s},
          {"fills_in_s", or_null(disk.fills_in_s)},
          {"held", disk.held}};
}

OrderedJson to_json(const ProblemView& problem) {
  return {{"key", problem.key},
          {"reason", without_path(problem.newest.source, problem.newest.reason)},
          {"state", job_state_name(problem.newest.state)},
          {"count", problem.count},
          {"changed_at", problem.newest.changed_at},
          {"newest", problem.newest.id}};
}

template <typename View>
OrderedJson array_of(const std::vector<View>& views) {
  OrderedJson result = OrderedJson::array();
  for (const View& view : views) result.push_back(to_json(view));
  return result;
}

}  // namespace

OrderedJson to_json(const JobView& job) {
  OrderedJson result = {{"id", job.id},
                        {"watch", job.watch},
                        {"source", job.source},
                        {"state", job_state_name(job.state)},
                        {"source_bytes", job.source_bytes},
                        {"attempts", job.attempts},
                        {"discovered_at", job.discovered_at},
                        {"changed_at", job.changed_at},
                        {"next_attempt_at", or_null(job.next_attempt_at)},
                        {"reason", job.reason},
                        {"exit_code", or_null(job.exit_code)},
                        {"seconds", or_null(job.seconds)},
                        {"bytes_read", job.bytes_read},
                        {"bytes_written", job.bytes_written},
                        {"peak_rss_bytes", job.peak_rss_bytes},
                        {"outputs", array_of(job.outputs)}};
  if (!job.log_tail.empty()) result["log_tail"] = job.log_tail;
  return result;
}

OrderedJson to_json(const JobPage& page, const JobQuery& query) {
  return {{"total", page.total}, {"offset", query.offset}, {"limit", query.limit}, {"jobs", array_of(page.jobs)}};
}

OrderedJson to_json(const StatusView& status) {
  return {{"version", status.version},
          {"config", status.config},
          {"state", status.state},
          {"reason", status.reason},
          {"started_at", status.started_at},
          {"queue_age_s", status.queue_age_s},
          {"bytes_per_s", status.bytes_per_s},
          {"jobs_at_once", status.jobs_at_once},
          {"jobs", counts(status.jobs)},
          {"done_total", status.done_total},
          {"bytes_in_total", status.bytes_in_total},
          {"bytes_out_total", status.bytes_out_total},
          {"arrived_per_min", status.arrived.per_min},
          {"arrived_bytes_per_s", status.arrived.bytes_per_s},
          {"done_per_min", status.converted.per_min},
          {"converted_bytes_per_s", status.converted.bytes_per_s},
          {"waiting_bytes", status.waiting_bytes},
          {"queue_ends_in_s", or_null(status.queue_ends_in_s)},
          {"disks", array_of(status.disks)},
          {"running", array_of(status.running)},
          {"watches", array_of(status.watches)},
          {"viewer", to_json(status.viewer)}};
}

OrderedJson to_json(const ViewerView& viewer) {
  return {{"state", kViewerStateNames.at(static_cast<std::size_t>(viewer.state))},
          {"reason", viewer.reason},
          {"file", viewer.file},
          {"connections", viewer.connections},
          {"rss_bytes", viewer.rss_bytes},
          {"memory_bytes", viewer.memory_bytes}};
}

OrderedJson to_json(const ProblemPage& page) { return {{"total", page.total}, {"groups", array_of(page.groups)}}; }

std::string json_line(const OrderedJson& json) { return json_text(json) + '\n'; }

}  // namespace weir
