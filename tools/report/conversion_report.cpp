#include "tools/report/conversion_report.h"

#include <spdlog/spdlog.h>

#include <nlohmann/json.hpp>

#include "format/base/json_text.h"
#include "format/base/printable.h"
#include "format/base/text.h"
#include "format/sidecar/valid_voxels.h"
#include "ingest/source/extent.h"
#include "tools/report/error_text.h"
#include "tools/report/volume_title.h"

namespace weir {
namespace {

// Returns the budget that a small volume was given instead of the default rate.
std::string default_text(const Sidecar& s, const Budget& budget) {
  if (budget.kind != Budget::Kind::automatic) return "";
  if (s.budget.kind == "psnr") return cat(" (default: ", kDefaultLeastDb, " dB)");
  return s.budget.kind == "lossless" ? " (default: lossless)" : "";
}

// Returns the text before the extent: "/qc at 2, magnitude, "; empty for a file that is one volume.
std::string chosen_prefix(const Sidecar::Source& source) {
  const std::string text = chosen_text(source.dataset, source.index, source.component);
  return text.empty() ? "" : text + ", ";
}

}  // namespace

void say_converted(const Sidecar& s, const Budget& budget, const std::string& output) {
  std::string error = error_text(s, s.error);
  if (s.visible && s.visible->blocks == 0) error += " (the scene shows nothing of it)";
  if (s.visible && s.visible->blocks > 0)
    error += cat(" (what the scene shows: ", error_text(s, s.visible->error), ')');
  if (s.gradient) error += cat(", gradient: ", gradient_text(*s.gradient, s.source.units));
  const Sidecar::Zeros zeros = s.zeros.value_or(Sidecar::Zeros{});
  for (const std::string& also : {lost_zeros_text(zeros.lost, zeros.count), missing_text(s), nonfinite_text(s),
                                  rounded_text(s.conversion_loss)}) {
    if (!also.empty()) error += cat(", ", also);
  }
  spdlog::info("{}: {}{} voxels, {} bytes, rate {:.4g}{}, {} of {} leaves kept, {}, {:.2f} s, {} peak", output,
               chosen_prefix(s.source), extent_text(s.source.extent), s.file.bytes, s.budget.rate,
               default_text(s, budget), s.selection.leaves_kept, s.selection.leaves_total, error, s.timing.total_s,
               format_bytes(s.timing.peak_rss_bytes));
}

void announce_output(const ProgressOptions& progress, const std::string& output, bool skipped, const Sidecar& s) {
  nlohmann::ordered_json line{{"output", output},
                              {"skipped", skipped},
                              {"bytes", s.file.bytes},
                              {"rate", s.budget.rate},
                              {"lossless", lossless_everywhere(s)},
                              {"psnr_db", nullptr},
                              {"source_bytes", s.source.bytes},
                              {"bytes_read", skipped ? 0 : s.timing.bytes_read},
                              {"peak_rss_bytes", skipped ? 0 : s.timing.peak_rss_bytes}};
  if (s.error.psnr_db) line["psnr_db"] = *s.error.psnr_db;
  line["max_error"] = s.error.max_abs;
  line["value_range"] = s.value_range;
  announce(progress, json_text(line));
}

void announce_failure(const ProgressOptions& progress, const Error& error) {
  nlohmann::json line{{"failed", one_line(error.message().worded(key_wording))}};
  if (const auto& failure = error.system_failure()) {
    line["errno"] = failure->errno_value;
    line["path"] = failure->path;
  }
  announce(progress, json_text(line));
}

}  // namespace weir
