// weir convert: volumes into NanoVDB files of exactly the asked size.
#include <spdlog/spdlog.h>
#include <CLI/CLI.hpp>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "compressor/build_commit.h"
#include "compressor/conversion.h"
#include "compressor/options/conversion_request.h"
#include "compressor/resume.h"
#include "format/base/error.h"
#include "format/base/text.h"
#include "format/io/bandwidth.h"
#include "format/io/file_id.h"
#include "format/io/limited_file_system.h"
#include "format/output/output_files.h"
#include "ingest/plan/limited_source.h"
#include "ingest/series.h"
#include "ingest/source/extent.h"
#include "ingest/source_registry.h"
#include "tools/command.h"
#include "tools/options/given_options.h"
#include "tools/options/run_options.h"
#include "tools/options/table_options.h"
#include "tools/options/trace_option.h"
#include "tools/report/finished_output.h"
#include "tools/report/progress.h"

namespace weir {
namespace {

/// The command line as given; empty: not given.
struct ConvertArguments {
  std::vector<std::string> inputs;
  std::string output;
  GivenOptions options;  ///< of input, method and run
  ProgressOptions progress;
  std::string within;  ///< a directory; empty: not asked for
  std::string trace;
  std::string bandwidth;  ///< a size, per second
  bool skip_done = false;
  bool again = false;
  bool json = false;
};

std::string error_text(const Sidecar::CertifiedError& error) {
  if (error.lossless) return "lossless";
  return cat("PSNR ", error.psnr_db.value_or(0), " dB, largest error ", error.max_abs);
}

void report(const Sidecar& s, const std::string& output) {
  std::string error = error_text(s.error);
  if (s.visible) error += cat(" (what the scene shows: ", error_text(s.visible->error), ')');
  spdlog::info("{}: {} bytes, rate {:.4g}, {} of {} leaves kept, {}, {:.2f} s, {} peak", output, s.file.bytes,
               s.budget.rate, s.selection.leaves_kept, s.selection.leaves_total, error, s.timing.total_s,
               format_bytes(s.timing.peak_rss_bytes));
}

// Bytes per second; none: no limit.
std::optional<std::uint64_t> parse_bandwidth(const std::string& text) {
  if (text.empty()) return std::nullopt;
  const auto bytes = parse_bytes(text);
  if (!bytes || *bytes == 0) {
    throw usage_error(cat("--bandwidth is \"", text, "\", it must be a size above 0, like 200MB (a second)"));
  }
  return bytes;
}

// What would be refused after minutes of work is refused before it.
void check_outputs(std::span<const SeriesStep> steps, std::span<const std::string> outputs, bool may_exist) {
  std::error_code ignored;
  std::vector<FileId> inputs;
  for (const SeriesStep& step : steps) {
    if (const auto id = file_id(step.path)) inputs.push_back(*id);
  }
  for (std::size_t i = 0; i < steps.size(); ++i) {
    check_output(steps[i].path, outputs[i]);
    require_not_input(inputs, outputs[i]);
    if (steps.size() > 1 && !may_exist && std::filesystem::exists(outputs[i], ignored)) {
      throw usage_error(cat(outputs[i], ": exists; choose another output or pass --overwrite"));
    }
  }
}

// A header may name any file that this process may read. Whoever lets others choose the inputs keeps them to a
// directory; to others it is said.
void check_files(const SourceInfo& info, const std::string& within) {
  if (info.files.empty()) return;
  if (const auto outside = within.empty() ? std::nullopt : file_outside(info.files, within)) {
    throw Error(ErrorKind::input, cat(info.path, ": lies in ", *outside, ", outside ", within,
                                      "; move it there, or convert it without --within, in a watch with follow = "
                                      "\"anywhere\""));
  }
  std::vector<FileState> others;
  for (const FileState& file : info.files) {
    if (file.path != info.path) others.push_back(file);
  }
  if (others.empty() || !within.empty()) return;
  if (const auto outside = file_outside(others, directory_of(info.path))) {
    spdlog::warn("{}: lies in {}, outside the directory of this file", info.path, *outside);
  }
}

// A player has two buffers of one size for all steps.
void check_alike(const Sidecar& first, const SourceInfo& info, const Budget& budget) {
  const bool by_extent = budget.kind == Budget::Kind::rate || budget.kind == Budget::Kind::automatic;
  if (!by_extent || info.extent == first.source.extent) return;
  throw Error(ErrorKind::input,
              cat(info.path, ": extent ", extent_text(info.extent), " differs from ", extent_text(first.source.extent),
                  " of ", first.source.path, ", so that a rate gives files of two sizes; give --size"));
}

// A kill may come between the end of a conversion and the removal of what it was made from.
void tidy_up(const std::string& output) {
  try {
    if (clear_leftovers(*make_posix_file_system(), output)) {
      spdlog::info("{}: what its conversion had left is removed", output);
    }
  } catch (const Error& error) {
    spdlog::warn("{}: what its conversion had left stays: {}", output, error.what());
  }
}

// The record of `options.output` where it is done; else makes room for it, if what stands there is weir's own.
std::optional<Sidecar> skip_or_replace(const SourceInfo& info, bool again, ConversionOptions& options) {
  FinishedOutput found = find_output(info, options);
  switch (found.state) {
    case FinishedOutput::State::absent:
      return std::nullopt;
    case FinishedOutput::State::done:
      if (again) {
        options.overwrite = true;
        return std::nullopt;
      }
      spdlog::info("{}: done already", options.output);
      tidy_up(options.output);
      return std::move(found.sidecar);
    case FinishedOutput::State::stale:
      spdlog::info("{}: converted again: {}", options.output, found.reason);
      options.overwrite = true;
      return std::nullopt;
    case FinishedOutput::State::foreign:
      if (options.overwrite) return std::nullopt;
      throw usage_error(cat(options.output, ": exists and is not of ", info.path, " (", found.reason,
                            "); choose another output or pass --overwrite"));
  }
  throw Error(ErrorKind::internal, "unknown state of an output");
}

// For the program that started this one.
void announce_output(const ProgressOptions& progress, const std::string& output, bool skipped, const Sidecar& s) {
  nlohmann::ordered_json line{{"output", output},
                              {"skipped", skipped},
                              {"bytes", s.file.bytes},
                              {"rate", s.budget.rate},
                              {"lossless", s.error.lossless},
                              {"psnr_db", nullptr},
                              {"bytes_read", skipped ? 0 : s.timing.bytes_read},
                              {"peak_rss_bytes", skipped ? 0 : s.timing.peak_rss_bytes}};
  if (s.error.psnr_db) line["psnr_db"] = *s.error.psnr_db;
  line["max_error"] = s.error.max_abs;
  line["value_range"] = s.value_range;
  announce(progress, line.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
}

Sidecar convert_step(const SeriesStep& step, SourceOptions source_options, ConversionOptions options,
                     const Sidecar* first, const ConvertArguments& a, Bandwidth* bandwidth, Trace* trace) {
  const ProgressOptions& shown = a.progress;
  source_options.dataset = step.dataset;
  source_options.index = step.index;
  std::unique_ptr<VolumeSource> source = open_source(step.path, source_options);
  check_files(source->info(), a.within);
  if (first != nullptr) check_alike(*first, source->info(), options.budget);
  if (a.skip_done) {
    if (auto record = skip_or_replace(source->info(), a.again, options)) {
      announce_output(shown, options.output, true, *record);
      return *std::move(record);
    }
  }
  Progress progress(shown);
  ConversionControl control;
  control.cancel = &interrupt_flag();
  control.trace = trace;
  control.pass_started = [&](const std::string& pass, std::uint64_t bytes) { progress.start(pass, bytes); };
  control.pass_advanced = [&](std::uint64_t done) { progress.update(done); };
  control.notice = [](const Message& line) { spdlog::warn("{}", line.text()); };
  control.planned = [&](std::uint64_t bytes) { announce(shown, nlohmann::json{{"planned", bytes}}.dump()); };
  const std::unique_ptr<FileSystem> unlimited = make_posix_file_system({control.notice});
  std::unique_ptr<FileSystem> limited;
  if (bandwidth != nullptr) {
    source = limit_source(std::move(source), *bandwidth);
    limited = limit_file_system(*unlimited, *bandwidth);
  }
  Sidecar sidecar = convert_volume(*source, options, control, limited ? *limited : *unlimited);
  progress.finish();
  report(sidecar, options.output);
  announce_output(shown, options.output, false, sidecar);
  return sidecar;
}

void print_json(std::span<const Sidecar> sidecars) {
  if (sidecars.size() == 1) {
    std::fputs(to_json_text(sidecars.front()).c_str(), stdout);
    return;
  }
  std::fputs("{\"steps\": [\n", stdout);
  for (const Sidecar& sidecar : sidecars) {
    std::fputs(to_json_text(sidecar).c_str(), stdout);
    if (&sidecar != &sidecars.back()) std::fputs(",\n", stdout);
  }
  std::fputs("]}\n", stdout);
}

void convert(const CLI::App& command, const ConvertArguments& a) {
  auto [source_options, options] = read_conversion_request(a.options);
  options.provenance = {WEIR_VERSION, build_commit(), given_options(command, a.options)};
  source_options.cancel = &interrupt_flag();

  const std::vector<SeriesStep> steps = expand_series(a.inputs, source_options);
  const std::vector<std::string> outputs = series_outputs(steps, a.output);
  check_outputs(steps, outputs, options.overwrite || a.skip_done);
  if (steps.size() > 1 && options.budget.kind == Budget::Kind::lossless) {
    spdlog::warn("--lossless: each of the {} files is as long as it needs; give --size for files of one size",
                 steps.size());
  }
  std::optional<Bandwidth> bandwidth;
  if (const auto bytes_per_s = parse_bandwidth(a.bandwidth)) bandwidth.emplace(*bytes_per_s, &interrupt_flag());
  std::vector<std::string> places;
  for (const SeriesStep& step : steps) places.push_back(step.path);
  for (const std::string& output : outputs) places.insert(places.end(), {output, sidecar_path(output)});
  const std::unique_ptr<Trace> trace = open_trace(a.trace, places);
  std::vector<Sidecar> sidecars;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    options.output = outputs[i];
    source_options.spool_directory = options.work_dir.empty() ? directory_of(options.output) : options.work_dir;
    sidecars.push_back(convert_step(steps[i], source_options, options, i == 0 ? nullptr : &sidecars.front(), a,
                                    bandwidth ? &*bandwidth : nullptr, trace.get()));
  }
  if (trace) trace->close();
  if (a.json) print_json(sidecars);
}

}  // namespace

void add_convert(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("convert", "Convert a volume to a NanoVDB file of exactly the size you ask for");
  const auto a = std::make_shared<ConvertArguments>();
  command
      ->add_option("input", a->inputs,
                   "volume file, NAME_XxYxZ_TYPE.raw for instance; several, or a pattern like 'run_%04d.raw', are "
                   "the steps of a series: one file each, all of one size")
      ->required();
  command->add_option("-o,--output", a->output,
                      "OUT.nvdb, or DIRECTORY/; default: the input's stem + .nvdb, beside it. For a series a "
                      "directory, or a name with {stem}, {dataset} or {step}");
  add_input_options(*command, a->options);
  add_method_options(*command, a->options);
  add_run_options(*command, a->options, a->progress);
  command
      ->add_option("--bandwidth", a->bandwidth,
                   "most bytes per second that are read and written, in the long run; default: no limit")
      ->type_name("SIZE")
      ->group("Run");
  add_option(*command, conversion_option("work-dir"), a->options);
  add_option(*command, conversion_option("resume"), a->options, "Run");
  add_option(*command, conversion_option("save-interval"), a->options, "Run");
  command
      ->add_option("--within", a->within,
                   "refuse inputs that lie in files outside this directory, symbolic links resolved: what a header, an "
                   "external or a virtual HDF5 dataset names; default: any file, with a notice where it is elsewhere")
      ->check(CLI::ExistingDirectory)
      ->type_name("DIRECTORY")
      ->group("Input");
  add_trace_option(*command, a->trace);
  add_option(*command, conversion_option("overwrite"), a->options);
  command->add_flag("--skip-done", a->skip_done,
                    "leave an output that this very conversion made of the same source; convert it again where the "
                    "source, the scene or an option has changed or the output is not whole");
  command->add_flag("--again", a->again, "with --skip-done: convert again what is done, too; others' files are left")
      ->needs("--skip-done");
  command->add_flag("--json", a->json, "print the sidecar on stdout");
  add_log_level(*command);
  command->callback([command, a] { convert(*command, *a); });
}

}  // namespace weir
