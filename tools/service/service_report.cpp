#include "tools/service/service_report.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "format/base/printable.h"
#include "format/base/text.h"

namespace weir {
namespace {

using Json = nlohmann::ordered_json;

std::string padded(std::string text, std::size_t width) {
  if (text.size() < width) text.resize(width, ' ');
  return text;
}

std::string right(const std::string& text, std::size_t width) {
  return std::string(width - std::min(width, text.size()), ' ') + text;
}

std::string text_at(const Json& json, const char* key) { return printable(json.at(key).get<std::string>()); }

std::string bytes_at(const Json& json, const char* key) { return format_bytes(json.at(key).get<std::uint64_t>()); }

// Returns "rate 8, 51.2 dB" for a job with one output, otherwise the number of outputs.
std::string result_text(const Json& outputs) {
  if (outputs.empty()) return "";
  if (outputs.size() > 1) return cat(outputs.size(), " outputs");
  const Json& output = outputs.front();
  const std::string rate = cat("rate ", std::round(output.at("rate").get<double>() * 100) / 100);
  if (output.at("lossless").get<bool>()) return rate + ", lossless";
  const Json& psnr = output.at("psnr_db");
  const Json largest = output.value("max_error", Json());
  if (psnr.is_null() && !largest.is_null() && largest.get<double>() == 0) return rate + ", lossless over valid voxels";
  return psnr.is_null() ? rate : cat(rate, ", ", fixed(psnr.get<double>(), 1), " dB");
}

std::string running_text(const Json& job) {
  const Json& fraction = job.at("fraction");
  const std::string share = fraction.is_null() ? "" : cat(std::floor(100 * fraction.get<double>()), " % after ");
  const bool thumbnail = job.at("step") == "render";  // the job itself is done, its thumbnail is being rendered
  return cat(thumbnail ? "thumbnail   " : "running     ", job.at("id").get<std::int64_t>(), ' ', text_at(job, "source"),
             ": ", text_at(job, "step"), ", ", share, duration_text(job.at("seconds").get<double>()), '\n');
}

// Returns ", 2 failed, 1 quarantined"; empty if there is none.
std::string problems_text(const Json& counts) {
  std::string text;
  for (const char* state : {"failed", "quarantined"}) {
    if (const auto count = counts.at(state).get<std::uint64_t>(); count > 0) text += cat(", ", count, ' ', state);
  }
  return text;
}

std::string watch_text(const Json& watch) {
  const std::string how = watch.at("up").get<bool>() ? text_at(watch, "method") : "DOWN: " + text_at(watch, "reason");
  const auto overflows = watch.at("overflows").get<std::uint64_t>();
  const std::string directory = text_at(watch, "directory");
  const std::string label = text_at(watch, "label");
  return cat("watch       ", label == directory ? "" : label + ": ", directory, " -> ", text_at(watch, "output"), ": ",
             how, ", ", watch.at("jobs").at("done").get<std::uint64_t>(), " done", problems_text(watch.at("jobs")),
             overflows > 0 ? cat(", ", overflows, " queue overflows") : std::string(), '\n');
}

std::string counts_text(const Json& status) {
  std::string text;
  for (const auto& [state, count] : status.at("jobs").items()) {
    if (count == 0 && state != "waiting" && state != "running") continue;
    text += cat(text.empty() ? "" : ", ", count.get<std::uint64_t>(), ' ', state);
    if (state == "waiting" && count != 0) {
      text += cat(" (the oldest for ", duration_text(status.at("queue_age_s").get<double>()), ')');
    }
  }
  return text;
}

}  // namespace

std::string duration_text(double seconds) {
  if (seconds < 10) return fixed(seconds, 1) + " s";
  if (seconds < 120) return fixed(seconds, 0) + " s";
  if (seconds < 7200) return fixed(seconds / 60, 0) + " min";
  if (seconds < 172800) return fixed(seconds / 3600, 0) + " h";
  return fixed(seconds / 86400, 0) + " days";
}

std::string jobs_text(const Json& page, double now) {
  const Json& jobs = page.at("jobs");
  const auto total = page.at("total").get<std::uint64_t>();
  const auto offset = page.at("offset").get<std::uint64_t>();
  if (jobs.empty()) return total == 0 ? "no such jobs\n" : cat("no jobs beyond ", total, '\n');
  std::string text = "     ID  STATE             SIZE         AGE  RESULT                SOURCE\n";
  for (const Json& job : jobs) {
    text += cat(right(cat(job.at("id").get<std::int64_t>()), 7), "  ", padded(text_at(job, "state"), 11),
                right(bytes_at(job, "source_bytes"), 11), ' ',
                right(duration_text(std::max(now - job.at("changed_at").get<double>(), 0.0)), 11), "  ",
                padded(result_text(job.at("outputs")) + " ", 22), text_at(job, "source"), '\n');
    const std::string reason = text_at(job, "reason");
    if (!reason.empty()) text += cat("         ", reason, '\n');
  }
  if (jobs.size() < total) {
    text += cat("jobs ", offset + 1, " to ", offset + jobs.size(), " of ", total, "; see --limit and --offset\n");
  }
  return text;
}

std::string status_text(const Json& status, double now) {
  const std::string reason = text_at(status, "reason");
  std::string text = cat("service     ", text_at(status, "state"), reason.empty() ? "" : " (" + reason + ")", ", weir ",
                         text_at(status, "version"), ", up ",
                         duration_text(std::max(now - status.at("started_at").get<double>(), 0.0)), ", ",
                         text_at(status, "config"), '\n');
  text += cat("jobs        ", counts_text(status), '\n');
  const auto speed = static_cast<std::uint64_t>(std::max(status.at("bytes_per_s").get<double>(), 0.0));
  text += cat("throughput  ", format_bytes(speed), "/s in the last minute; since start ",
              status.at("done_total").get<std::uint64_t>(), " conversions, ", bytes_at(status, "bytes_in_total"),
              " in, ", bytes_at(status, "bytes_out_total"), " out\n");
  for (const Json& job : status.at("running")) text += running_text(job);
  for (const Json& watch : status.at("watches")) text += watch_text(watch);
  return text;
}

}  // namespace weir
