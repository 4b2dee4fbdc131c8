#include "tools/report/forecast_report.h"

#include <cmath>
#include <cstdint>

#include "format/base/printable.h"
#include "format/base/scalar_type.h"
#include "format/base/share_text.h"
#include "format/base/text.h"
#include "ingest/source/extent.h"
#include "tools/report/error_text.h"
#include "tools/report/json_loss.h"

namespace weir {
namespace {

std::uint64_t voxels_of(const SourceInfo& source) { return static_cast<std::uint64_t>(source.domain().voxels()); }

std::uint64_t whole_number(double value) { return static_cast<std::uint64_t>(std::llround(value)); }

bool has_spread(const Expected& expected) { return expected.low < expected.high; }

std::string seconds_text(double seconds) { return cat(fixed(seconds, seconds < 10 ? 1 : 0), " s"); }

// Returns one line of the report. `text` may hold names from a foreign file, so it is made safe.
std::string line(const std::string& what, const std::string& text) {
  constexpr std::size_t kColumn = 10;
  std::string head = cat("  ", what);
  head.resize(kColumn + 2, ' ');
  return cat(head, one_line(text), "\n");
}

std::string sample_text(const Forecast& f, const SourceInfo& source) {
  if (f.whole) return "all of the volume was converted and nothing kept: file and error are exact";
  return cat(share_text(f.sampled_voxels, voxels_of(source)), " of the voxels, from ", f.places,
             f.places == 1 ? " place" : " places", " of the volume");
}

std::string file_text(const Forecast& f, const std::string& output) {
  if (f.file_bytes.value == 0) return cat(output, ": as long as it needs");
  std::string text = cat(output, ": ", f.exact_bytes ? "" : "about ", whole_number(f.file_bytes.value), " bytes");
  if (!f.exact_bytes && has_spread(f.file_bytes)) {
    text += cat(" (", whole_number(f.file_bytes.low), " to ", whole_number(f.file_bytes.high), ")");
  }
  if (f.scratch_bytes > 0) text += cat(", and ", format_bytes(f.scratch_bytes), " until it is done");
  return text;
}

// Whether the PSNR is the one that the budget asked for. That PSNR holds for all voxels, or for those that a scene
// shows, so it is not an estimate from a sample.
enum class Asked { no, yes };

Asked of_all(const ConversionOptions& options) {
  return options.budget.by_error() && !options.scene ? Asked::yes : Asked::no;
}

Asked of_shown(const ConversionOptions& options) { return options.budget.by_error() ? Asked::yes : Asked::no; }

std::string error_text(const ForecastError& e, bool whole, Asked asked) {
  if (e.lossless) return whole ? "lossless" : "lossless in the sample";
  std::string text = e.psnr_db ? cat(whole ? "PSNR " : "PSNR about ", fixed(e.psnr_db->value, 1), " dB") : "";
  if (e.psnr_db && asked == Asked::no && has_spread(*e.psnr_db)) {
    text += cat(" (", fixed(e.psnr_db->low, 1), " to ", fixed(e.psnr_db->high, 1), ")");
  }
  text += cat(e.psnr_db ? ", " : "", "RMSE ", short_number(e.rmse));
  if (whole) text += cat(", largest error ", short_number(e.max_abs));
  return text;
}

std::string error_line(const Forecast& f, const ConversionOptions& options) {
  if (std::isnan(f.value_low)) return cat("none: no value of the ", f.whole ? "volume" : "sample", " is finite");
  const std::string of_sample = f.whole || f.error.lossless ? "" : ", range and background of the sample";
  return cat(error_text(f.error, f.whole, of_all(options)), ", values from ", short_number(f.value_low), " to ",
             short_number(f.value_high), of_sample);
}

std::string shown_line(const Forecast& f, const ConversionOptions& options) {
  if (!f.shown) return cat("nothing of the ", f.whole ? "volume" : "sample");
  return cat(error_text(*f.shown, f.whole, of_shown(options)), ", over ", share_text(f.shown_voxels, f.sampled_voxels),
             " of the voxels");
}

// Returns what the conversion to float32 loses, which the error does not count; empty if nothing is lost.
std::string rounded_line(const Forecast& f) {
  const std::string text = rounded_text(f.loss);
  return text.empty() ? "" : cat(text, f.whole ? "" : ", in the sample", "; the error does not count that");
}

// Returns the budget that is used when none was given; empty if one was given.
std::string default_budget_text(const Forecast& f, const ConversionOptions& options) {
  if (options.budget.kind != Budget::Kind::automatic) return "";
  const std::string rate = cat("--rate ", options.budget.rate);
  if (f.budget == "psnr") {
    return cat("none was given, and ", rate, " would keep less than ", kDefaultLeastDb,
               " dB: as few bytes as keep that");
  }
  if (f.budget == "lossless") {
    return cat("none was given, and ", rate, " would keep less than ", kDefaultLeastDb, " dB: lossless");
  }
  if (f.budget == "minimum") return cat("none was given, and ", rate, " is less than the smallest tree takes: that");
  return cat("none was given: ", rate);
}

nlohmann::ordered_json to_json(const Expected& expected, bool with_spread) {
  nlohmann::ordered_json json{{"value", expected.value}, {"low", nullptr}, {"high", nullptr}};
  if (!with_spread || !has_spread(expected)) return json;
  json["low"] = expected.low;
  json["high"] = expected.high;
  return json;
}

nlohmann::ordered_json to_json(const ForecastError& error, bool whole, Asked asked) {
  nlohmann::ordered_json json{
      {"lossless", error.lossless}, {"psnr_db", nullptr}, {"rmse", error.rmse}, {"max_abs", nullptr}};
  if (error.psnr_db) json["psnr_db"] = to_json(*error.psnr_db, asked == Asked::no);
  if (whole) json["max_abs"] = error.max_abs;
  return json;
}

}  // namespace

std::string forecast_text(const Forecast& f, const SourceInfo& source, const ConversionOptions& options) {
  std::string text = cat(one_line(source.path), ": ", extent_text(source.extent), " voxels of ",
                         scalar_name(source.type), ", ", format_bytes(f.volume_bytes), "\n");
  const bool sampled = f.not_sampled.empty();
  text += line("sample", sampled ? sample_text(f, source) : cat("none: ", f.not_sampled));
  if (sampled) text += line("reads", cat(format_bytes(f.read_bytes), " in ", fixed(f.passes, 1), " passes"));
  text += line("writes", file_text(f, options.output));
  text += line("memory", cat("up to ", format_bytes(f.memory_bytes), " of ", format_bytes(options.memory), ", ",
                             f.threads, f.threads == 1 ? " thread" : " threads", f.on_device ? " and a device" : ""));
  if (!sampled) return text;
  if (const std::string budget = default_budget_text(f, options); !budget.empty()) text += line("budget", budget);
  text += line("encoding", f.encoding);
  text += line("error", error_line(f, options));
  if (const std::string rounded = rounded_line(f); !rounded.empty()) text += line("rounded", rounded);
  if (options.scene) text += line("shown", shown_line(f, options));
  text += line("time", cat("about ", seconds_text(f.total_s()), ": survey ", seconds_text(f.survey_s), ", encoding ",
                           seconds_text(f.encode_s)));
  return text;
}

nlohmann::ordered_json forecast_json(const Forecast& f, const SourceInfo& source, const ConversionOptions& options) {
  const bool sampled = f.not_sampled.empty();
  nlohmann::ordered_json json{{"dry_run", 1}, {"input", source.path}, {"output", options.output}, {"exact", f.whole}};
  json["sample"] = {{"voxels", f.sampled_voxels},
                    {"share", static_cast<double>(f.sampled_voxels) / static_cast<double>(voxels_of(source))},
                    {"places", f.places},
                    {"parts", f.parts},
                    {"none", sampled ? nlohmann::ordered_json() : nlohmann::ordered_json(f.not_sampled)}};
  json["read"] = {{"volume_bytes", f.volume_bytes}, {"bytes", nullptr}, {"passes", nullptr}};
  json["file"] = nullptr;
  if (f.file_bytes.value > 0) {
    json["file"] = to_json(f.file_bytes, !f.exact_bytes);
    json["file"]["exact"] = f.exact_bytes;
  }
  json["scratch_bytes"] = nullptr;
  json["memory"] = {{"ceiling_bytes", options.memory}, {"planned_bytes", f.memory_bytes}};
  json["threads"] = f.threads;
  json["backend"] = f.on_device ? "cuda" : "cpu";
  json["budget"] = nullptr;
  json["encoding"] = nullptr;
  json["error"] = nullptr;
  json["conversion_loss"] = nullptr;
  json["visible"] = nullptr;
  json["time"] = nullptr;
  if (!sampled) return json;
  json["read"]["bytes"] = f.read_bytes;
  json["read"]["passes"] = f.passes;
  json["scratch_bytes"] = f.scratch_bytes;
  json["budget"] = f.budget;
  json["encoding"] = f.encoding;
  json["time"] = {{"survey_s", f.survey_s}, {"encode_s", f.encode_s}, {"total_s", f.total_s()}};
  json["error"] = to_json(f.error, f.whole, of_all(options));
  json["error"]["value_range"] = {f.value_low, f.value_high};
  json["conversion_loss"] = loss_json(f.loss);
  if (!f.shown) return json;
  json["visible"] = {{"share", static_cast<double>(f.shown_voxels) / static_cast<double>(f.sampled_voxels)}};
  json["visible"].update(to_json(*f.shown, f.whole, of_shown(options)));
  return json;
}

}  // namespace weir
