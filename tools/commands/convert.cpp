// weir convert: converts volumes to NanoVDB files of exactly the requested size.
#include <spdlog/spdlog.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdio>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "compressor/build_commit.h"
#include "compressor/conversion.h"
#include "compressor/forecast/forecast.h"
#include "compressor/levels/level_budgets.h"
#include "compressor/options/conversion_request.h"
#include "compressor/resume.h"
#include "format/base/error.h"
#include "format/base/json_text.h"
#include "format/base/text.h"
#include "format/io/bandwidth.h"
#include "format/io/limited_file_system.h"
#include "format/io/output_names.h"
#include "gpu/packed/coder_choice.h"
#include "ingest/file_values.h"
#include "ingest/plan/limited_source.h"
#include "ingest/series_names.h"
#include "ingest/source_registry.h"
#include "tools/command.h"
#include "tools/command_request.h"
#include "tools/options/given_options.h"
#include "tools/options/result_directory.h"
#include "tools/options/run_options.h"
#include "tools/options/series_checks.h"
#include "tools/options/table_options.h"
#include "tools/options/trace_option.h"
#include "tools/report/conversion_report.h"
#include "tools/report/finished_output.h"
#include "tools/report/forecast_report.h"
#include "tools/report/opacity_warning.h"
#include "tools/report/progress.h"

namespace weir {
namespace {

/// The command line as given; empty: not given.
struct ConvertArguments {
  std::vector<std::string> inputs;
  std::string output;
  GivenOptions options;  ///< options of input, method and run
  ProgressOptions progress;
  std::string within;  ///< directory that inputs must lie in; empty: not asked for
  std::string trace;
  std::string bandwidth;  ///< bytes per second, as a size
  bool skip_done = false;
  bool again = false;
  bool brief_names = false;
  bool count_values = false;
  bool json = false;
  bool dry_run = false;
};

// Returns bytes per second; nullopt: no limit.
std::optional<std::uint64_t> parse_bandwidth(const std::string& text) {
  if (text.empty()) return std::nullopt;
  const auto bytes = parse_bytes(text);
  if (!bytes || *bytes == 0) {
    throw usage_error(cat("--bandwidth is \"", text, "\", it must be a size above 0, like 200MB (a second)"));
  }
  return bytes;
}

// A header may name any file. Refuses files outside --within; without --within, warns of one that lies outside the
// input's directory.
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

// Removes leftovers, because a kill may come between the end of a conversion and the removal of its working files.
void tidy_up(const std::string& output) {
  try {
    if (discard_all_beside(*make_posix_file_system(), output)) {
      spdlog::info("{}: what its conversion had left is removed", output);
    }
  } catch (const Error& error) {
    spdlog::warn("{}: what its conversion had left stays: {}", output, error.what());
  }
}

// Returns the record of `options.output` if the conversion is done; otherwise makes room for it, if weir's own file
// stands there.
std::optional<Sidecar> skip_or_replace(const SourceInfo& info, const ConvertArguments& a, ConversionOptions& options) {
  FinishedOutput found = find_output(info, options);
  switch (found.state) {
    case FinishedOutput::State::absent:
      return std::nullopt;
    case FinishedOutput::State::done:
      if (a.again) {
        options.overwrite = true;
        return std::nullopt;
      }
      spdlog::info("{}: done already", options.output);
      if (!a.dry_run) tidy_up(options.output);
      return std::move(found.sidecar);
    case FinishedOutput::State::stale:
      spdlog::info("{}: {}converted again: {}", options.output, a.dry_run ? "would be " : "", found.reason);
      options.overwrite = true;
      return std::nullopt;
    case FinishedOutput::State::foreign:
      if (options.overwrite) return std::nullopt;
      throw usage_error(compose(options.output, ": exists and is not of ", info.path, " (", found.reason, "); ",
                                CommandLineText{"choose another output or pass --overwrite",
                                                "move that file away, or choose another output or name"}));
    case FinishedOutput::State::unreadable:
      if (options.overwrite) return std::nullopt;
      throw Error(ErrorKind::io, found.reason);
  }
  throw Error(ErrorKind::internal, "unknown state of an output");
}

// Warns if files differ in size: the default budget gives a small volume more than its rate if needed.
void say_sizes(std::span<const SeriesStep> steps, std::span<const std::string> outputs, std::span<const Sidecar> made,
               const Budget& budget) {
  if (budget.kind != Budget::Kind::automatic) return;
  std::map<std::string, std::size_t> first;  // first step of each series
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const std::size_t one = first.emplace(steps[i].series, i).first->second;
    if (made[i].file.bytes == made[one].file.bytes) continue;
    spdlog::warn("{}: {} bytes, and {} has {}; give --size for files of one size", outputs[i], made[i].file.bytes,
                 outputs[one], made[one].file.bytes);
    return;
  }
}

// Warns of the scene's opacity: values that the table misses count as hidden, and their bytes are saved.
void say_opacity(const ConversionOptions& options) {
  if (!options.scene) return;
  if (const std::string line = opacity_warning(options.scene->scene); !line.empty()) {
    spdlog::warn("{}: {}", options.scene->path, line);
  }
}

std::unique_ptr<VolumeSource> open_step(const SeriesStep& step, const SourceOptions& options) {
  return open_source(step.path, options_of_step(options, step));
}

// The data that all steps of one call share.
struct SeriesWork {
  const ConvertArguments& arguments;
  SeriesExtents& extents;
  Bandwidth* bandwidth;  ///< null: no limit
  BlockCoder* coder;     ///< null: the CPU
  Trace* trace;          ///< null: none
};

std::unique_ptr<VolumeSource> open_checked(const SeriesStep& step, const SourceOptions& options,
                                           const SeriesWork& work) {
  std::unique_ptr<VolumeSource> source = open_step(step, options);
  check_files(source->info(), work.arguments.within);
  work.extents.check(step, source->info());
  return source;
}

// Calls action(source, files); both keep to the bandwidth limit.
template <typename Action>
void with_bandwidth(std::unique_ptr<VolumeSource> source, const SeriesWork& work, const Action& action) {
  const std::unique_ptr<FileSystem> unlimited = make_posix_file_system({log_notice});
  if (work.bandwidth == nullptr) return action(*source, *unlimited);
  source = limit_source(std::move(source), *work.bandwidth);
  const std::unique_ptr<FileSystem> limited = limit_file_system(*unlimited, *work.bandwidth);
  action(*source, *limited);
}

ConversionControl control_of(const SeriesWork& work, Progress& progress) {
  ConversionControl control;
  control.cancel = &interrupt_flag();
  control.trace = work.trace;
  control.coder = work.coder;
  control.pass_started = [&progress](const std::string& pass, std::uint64_t bytes) { progress.start(pass, bytes); };
  control.pass_advanced = [&progress](std::uint64_t done) { progress.update(done); };
  control.notice = log_notice;
  return control;
}

Sidecar convert_step(const SeriesStep& step, const SourceOptions& source_options, ConversionOptions options,
                     const SeriesWork& work) {
  const ConvertArguments& a = work.arguments;
  std::unique_ptr<VolumeSource> source = open_checked(step, source_options, work);
  if (a.skip_done) {
    if (auto record = skip_or_replace(source->info(), a, options)) {
      announce_output(a.progress, options.output, true, *record);
      return *std::move(record);
    }
  }
  if (a.count_values) options.source_values = file_values(step.path, source_options);
  Progress progress(a.progress);
  ConversionControl control = control_of(work, progress);
  if (a.progress.descriptor >= 0) {  // the reader may first have to make room
    control.planned = [&](std::uint64_t bytes) { announce(a.progress, nlohmann::json{{"planned", bytes}}.dump()); };
  }
  Sidecar sidecar;
  with_bandwidth(std::move(source), work, [&](VolumeSource& volume, FileSystem& files) {
    sidecar = convert_volume(volume, options, control, files);
  });
  progress.finish();
  say_converted(sidecar, options.budget, options.output);
  announce_output(a.progress, options.output, false, sidecar);
  return sidecar;
}

// For --dry-run: prints or returns the forecast of convert_step.
nlohmann::ordered_json forecast_step(const SeriesStep& step, const SourceOptions& source_options,
                                     ConversionOptions options, const SeriesWork& work) {
  const ConvertArguments& a = work.arguments;
  std::unique_ptr<VolumeSource> source = open_checked(step, source_options, work);
  if (a.skip_done && skip_or_replace(source->info(), a, options)) {
    return {{"dry_run", 1}, {"input", source->info().path}, {"output", options.output}, {"done", true}};
  }
  Progress progress(a.progress);
  const ConversionControl control = control_of(work, progress);
  nlohmann::ordered_json json;
  with_bandwidth(std::move(source), work, [&](VolumeSource& volume, FileSystem& files) {
    const Forecast forecast = forecast_conversion(volume, options, control, files);
    progress.finish();
    json = forecast_json(forecast, volume.info(), options);
    if (!a.json) std::fputs(forecast_text(forecast, volume.info(), options).c_str(), stdout);
  });
  return json;
}

// The results of the steps of one call.
struct StepResults {
  std::vector<Sidecar> sidecars;
  std::vector<nlohmann::ordered_json> forecasts;  // with --dry-run, which makes no sidecars
};

StepResults convert_steps(std::span<const SeriesStep> steps, std::span<const std::string> outputs,
                          SourceOptions source_options, ConversionOptions options, const SeriesWork& work) {
  const auto open = [&](const SeriesStep& step) { return open_step(step, source_options); };
  StepResults results;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    options.output = outputs[i];
    source_options.spool_directory = options.work_dir.empty() ? directory_of(options.output) : options.work_dir;
    check_level_budgets(steps, outputs, i, options, open);
    if (work.arguments.dry_run) {
      results.forecasts.push_back(forecast_step(steps[i], source_options, options, work));
      continue;
    }
    try {
      results.sidecars.push_back(convert_step(steps[i], source_options, options, work));
    } catch (const std::exception&) {
      if (steps.size() > 1) {  // named by its output, because several volumes may come from one file
        spdlog::warn("{} of {} volumes were converted, and none from {} on; --skip-done leaves out what is done", i,
                     steps.size(), outputs[i]);
      }
      throw;
    }
  }
  return results;
}

void print_json(std::span<const nlohmann::ordered_json> forecasts) {
  const nlohmann::ordered_json json =
      forecasts.size() == 1 ? forecasts.front() : nlohmann::ordered_json{{"steps", forecasts}};
  std::fputs((json_text(json, 2) + "\n").c_str(), stdout);
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
  auto [source_options, options] = command_request(a.options);
  options.provenance = {WEIR_VERSION, build_commit(), given_options(command, a.options)};
  say_opacity(options);
  const std::vector<SeriesStep> steps = expand_series(a.inputs, source_options, log_notice);
  const std::vector<std::string> outputs =
      series_outputs(steps, a.output, source_options, a.brief_names ? DefaultNames::of_call : DefaultNames::of_file);
  check_outputs(steps, outputs, options.overwrite || a.skip_done);
  if (steps.size() > 1 && options.budget.kind == Budget::Kind::lossless) {
    spdlog::warn("--lossless: each of the {} files is as long as it needs; give --size for files of one size",
                 steps.size());
  }
  SeriesExtents extents(options.budget);
  extents.check_all(steps, [&of = source_options](const SeriesStep& step) { return open_step(step, of); });
  std::optional<Bandwidth> bandwidth;
  if (const auto bytes_per_s = parse_bandwidth(a.bandwidth)) bandwidth.emplace(*bytes_per_s, &interrupt_flag());
  std::vector<std::string> places;
  for (const SeriesStep& step : steps) places.push_back(step.path);
  for (const std::string& output : outputs) places.insert(places.end(), {output, sidecar_path(output)});
  const std::unique_ptr<Trace> trace = open_trace(a.trace, places);
  const std::unique_ptr<FileSystem> files = make_posix_file_system();
  std::optional<ResultDirectory> directory;
  if (a.output.ends_with('/')) directory.emplace(*files, directory_of(a.output));
  const std::unique_ptr<BlockCoder> coder =
      choose_coder(options.backend, options.encoding == Encoding::packed, options.memory, log_notice);
  const SeriesWork work{a, extents, bandwidth ? &*bandwidth : nullptr, coder.get(), trace.get()};
  const StepResults results = convert_steps(steps, outputs, source_options, options, work);
  if (trace) trace->close();
  if (a.dry_run) {
    if (a.json) print_json(results.forecasts);
    return;
  }
  say_sizes(steps, outputs, results.sidecars, options.budget);
  if (a.json) print_json(results.sidecars);
}

}  // namespace

void add_convert(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("convert", "Converts a volume to a NanoVDB file of exactly the size you ask for");
  const auto a = std::make_shared<ConvertArguments>();
  command
      ->add_option("input", a->inputs,
                   "volume file, NAME_XxYxZ_TYPE.raw for instance; several, or a pattern like 'run_%04d.raw', are "
                   "the steps of a series: one file each, with --size or --rate all of one size")
      ->required();
  command->add_option("-o,--output", a->output,
                      "OUT.nvdb, or DIRECTORY/, which is made where it is missing; default: the input's stem + .nvdb, "
                      "beside it, and of an input that holds several volumes STEM_DATASET_COMPONENT_INDEX.nvdb, with "
                      "what was chosen among several. For a series a directory, or a name with {stem}, {dataset} or "
                      "{step}");
  add_input_options(*command, a->options);
  add_method_options(*command, a->options);
  add_run_options(*command, a->options, a->progress);
  command
      ->add_option("--bandwidth", a->bandwidth,
                   "most bytes per second that are read and written, in the long run; default: no limit")
      ->type_name("SIZE")
      ->group("Run");
  add_option(*command, conversion_option("backend"), a->options, "Run");
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
  command
      ->add_flag(
          "--count-values", a->count_values,
          "for weir watch, which deletes sources of which it has all: the sidecar says how many values the input holds")
      ->group("");
  command
      ->add_flag("--brief-names", a->brief_names, "for weir watch, whose names say what the volumes of one call need")
      ->group("");
  command->add_flag("--json", a->json, "print the sidecar on stdout");
  command
      ->add_flag("--dry-run", a->dry_run,
                 "write nothing: say what the conversion would read, write and take, how long, and what error it would "
                 "have; by a sample, of a volume of more than 512 MiB of float32")
      ->excludes("--trace");
  add_log_level(*command);
  command->callback([command, a] {
    try {
      convert(*command, *a);
    } catch (const Error& error) {
      announce_failure(a->progress, error);
      throw;
    }
  });
}

}  // namespace weir
