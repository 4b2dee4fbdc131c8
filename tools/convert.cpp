// weir convert: a volume into a NanoVDB file of exactly the asked size.
#include <spdlog/spdlog.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include "compressor/conversion.h"
#include "format/error.h"
#include "format/output_files.h"
#include "format/text.h"
#include "ingest/source_registry.h"
#include "tools/command.h"
#include "tools/input_options.h"
#include "tools/progress.h"
#include "tools/run_options.h"

namespace weir {
namespace {

/// The command line as given; empty: not given.
struct ConvertArguments {
  std::string input;
  std::string output;
  InputArguments source;
  RunArguments run;
  std::string non_finite = "error";
  std::string size;
  std::string rate;
  bool lossless = false;
  std::string encoding = "auto";
  std::string metric = "sse";
  std::string fill = "mean";
  std::string background = "auto";
  std::string brick = "8";
  std::string preset;
  std::string work_dir;
  bool overwrite = false;
  bool json = false;
};

Error usage(const std::string& message) { return {ErrorKind::usage, message}; }

Budget parse_budget(const ConvertArguments& a) {
  if ((a.size.empty() ? 0 : 1) + (a.rate.empty() ? 0 : 1) + (a.lossless ? 1 : 0) > 1) {
    throw usage("--size, --rate and --lossless exclude each other; give one");
  }
  Budget budget;
  if (a.lossless) budget.kind = Budget::Kind::lossless;
  if (!a.size.empty()) {
    const auto bytes = parse_bytes(a.size);
    if (!bytes || *bytes == 0) {
      throw usage(cat("--size is \"", a.size, "\", it must be a size such as 1048577, 64MiB or 1.5GB"));
    }
    budget.kind = Budget::Kind::size;
    budget.bytes = *bytes;
  }
  if (!a.rate.empty()) {
    const auto rate = parse_double(a.rate);
    // Above 2^60 no volume has a byte left; below 2^-20 no disk holds the file.
    if (!rate || !(*rate >= 0x1p-20 && *rate <= 0x1p60)) {
      throw usage(cat("--rate is \"", a.rate, "\", it must be a positive number: dense float32 bytes / file bytes"));
    }
    budget.kind = Budget::Kind::rate;
    budget.rate = *rate;
  }
  return budget;
}

Metric parse_metric(const std::string& name) {
  for (const Metric metric : {Metric::sse, Metric::farthest, Metric::closest, Metric::median}) {
    if (metric_name(metric) == name) return metric;
  }
  throw usage(cat("--metric is \"", name, "\", it must be sse, farthest, closest or median"));
}

FillMode parse_fill(const std::string& name) {
  for (const FillMode fill : {FillMode::mean, FillMode::background}) {
    if (fill_name(fill) == name) return fill;
  }
  throw usage(cat("--fill is \"", name, "\", it must be mean or background"));
}

NonFinitePolicy parse_policy(const std::string& name) {
  for (const NonFinitePolicy policy : {NonFinitePolicy::error, NonFinitePolicy::background, NonFinitePolicy::keep}) {
    if (policy_name(policy) == name) return policy;
  }
  throw usage(cat("--nonfinite is \"", name, "\", it must be error, background or keep"));
}

void parse_method(const CLI::App& command, const ConvertArguments& a, ConversionOptions& options) {
  if (a.encoding != "auto" && a.encoding != "float") {
    throw usage(cat("--encoding is \"", a.encoding, "\", it must be auto or float"));
  }
  options.metric = parse_metric(a.metric);
  options.fill = parse_fill(a.fill);
  const auto brick = parse_int(a.brick);
  if (!brick || (*brick != 8 && *brick != 16 && *brick != 32)) {
    throw usage(cat("--brick is \"", a.brick, "\", it must be 8, 16 or 32"));
  }
  options.brick = *brick;
  if (!a.preset.empty()) {
    if (a.preset != "paper") throw usage(cat("--preset is \"", a.preset, "\", the one there is is paper"));
    for (const char* fixed : {"--metric", "--fill", "--background"}) {
      if (command.count(fixed) > 0) throw usage(cat("--preset paper sets ", fixed, "; leave one of them out"));
    }
    options.metric = Metric::farthest;
    options.fill = FillMode::background;
    options.paper_background = true;
  }
  if (options.metric == Metric::sse && options.brick != 8) {
    throw usage(
        cat("--brick ", options.brick, " is for --metric farthest, closest or median; sse chooses single leaves"));
  }
  if (a.background != "auto") {
    const auto value = parse_double(a.background);
    const auto rounded = value ? static_cast<float>(*value) : 0.0F;
    if (!value || !(rounded - rounded == 0)) {
      throw usage(cat("--background is \"", a.background, "\", it must be auto or a finite float32"));
    }
    options.background = rounded;
  }
}

// Every option that was given, by its long name: the sidecar's weir.options.
std::map<std::string, std::string> given_options(const CLI::App& command) {
  std::map<std::string, std::string> given;
  for (const CLI::Option* option : command.get_options()) {
    if (option->count() == 0 || option->get_lnames().empty()) continue;
    const std::string& name = option->get_lnames().front();
    if (name == "help" || name == "json" || name == "progress" || name == "log-level") continue;
    given[name] = option->get_expected_max() == 0 ? "true" : option->results().back();
  }
  return given;
}

std::string default_output(const std::string& input) {
  return std::filesystem::path(input).replace_extension(".nvdb").string();
}

void report(const Sidecar& s, const std::string& output) {
  const std::string error =
      s.error.lossless ? "lossless" : cat("PSNR ", s.error.psnr_db.value_or(0), " dB, largest error ", s.error.max_abs);
  spdlog::info("{}: {} bytes, rate {:.4g}, {} of {} leaves kept, {}, {:.2f} s, {} at most", output, s.file.bytes,
               s.budget.rate, s.selection.leaves_kept, s.selection.leaves_total, error, s.timing.total_s,
               format_bytes(s.timing.peak_rss_bytes));
}

void convert(const CLI::App& command, const ConvertArguments& a) {
  ConversionOptions options;
  options.output = a.output.empty() ? default_output(a.input) : a.output;
  options.overwrite = a.overwrite;
  options.budget = parse_budget(a);
  options.non_finite = parse_policy(a.non_finite);
  parse_method(command, a, options);
  options.memory = parse_memory(a.run);
  options.threads = static_cast<std::size_t>(a.run.threads);
  options.work_dir = a.work_dir;
  options.provenance = {WEIR_VERSION, WEIR_COMMIT, given_options(command)};

  SourceOptions source_options = parse_input(a.source);
  source_options.memory = options.memory;
  source_options.spool_directory = a.work_dir.empty() ? directory_of(options.output) : a.work_dir;
  const std::unique_ptr<VolumeSource> source = open_source(a.input, source_options);
  std::error_code ignored;
  if (std::filesystem::equivalent(a.input, options.output, ignored)) {
    throw usage(cat(options.output, ": is the input; choose another output with -o"));
  }
  if (std::filesystem::is_directory(options.output, ignored)) {
    throw usage(cat(options.output, ": is a directory; name a file in it with -o"));
  }
  Progress progress(a.run.progress);
  ConversionControl control;
  control.cancel = &interrupt_flag();
  control.pass_started = [&](const std::string& pass, std::uint64_t bytes) { progress.start(pass, bytes); };
  control.pass_advanced = [&](std::uint64_t done) { progress.update(done); };
  control.notice = [](const std::string& line) { spdlog::warn("{}", line); };
  const std::unique_ptr<FileSystem> files = make_posix_file_system();
  const Sidecar sidecar = convert_volume(*source, options, control, *files);
  progress.finish();
  report(sidecar, options.output);
  if (a.json) std::fputs(to_json_text(sidecar).c_str(), stdout);
}

}  // namespace

void add_convert(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("convert", "Convert a volume to a NanoVDB file of exactly the size you ask for");
  const auto a = std::make_shared<ConvertArguments>();
  command->add_option("input", a->input, "volume file, NAME_XxYxZ_TYPE.raw for instance")->required();
  command->add_option("-o,--output", a->output, "OUT.nvdb; default: the input's stem + .nvdb, beside it");
  add_input_options(*command, a->source);
  command->add_option("--nonfinite", a->non_finite, "NaN and infinite voxels: error, background or keep")
      ->capture_default_str();
  command->add_option("--size", a->size, "the file is exactly that long, 64MiB for instance");
  command->add_option("--rate", a->rate,
                      "the file is exactly ceil(float32 bytes of the volume / RATE) long; default 8");
  command->add_flag("--lossless", a->lossless, "as long as every bit of every voxel needs");
  command->add_option("--encoding", a->encoding, "leaves: auto or float")->capture_default_str();
  command
      ->add_option("--metric", a->metric,
                   "what the budget is spent on: sse (squared error saved per byte), farthest, closest or median "
                   "(the paper's distances from a brick's range to the background)")
      ->capture_default_str();
  command->add_option("--fill", a->fill, "what dropped blocks read: mean or background")->capture_default_str();
  command->add_option("--background", a->background, "auto (the most frequent value) or a value")
      ->capture_default_str();
  command->add_option("--brick", a->brick, "granularity of the paper's metrics in voxels: 8, 16 or 32")
      ->capture_default_str();
  command->add_option("--preset", a->preset,
                      "paper: --encoding float --metric farthest --fill background and the paper's background");
  add_run_options(*command, a->run);
  command->add_option("--work-dir", a->work_dir,
                      "for spill files, on a disk; default: a hidden directory beside the output");
  command->add_flag("--overwrite", a->overwrite, "replace an existing output");
  command->add_flag("--json", a->json, "print the sidecar on stdout");
  add_log_level(*command);
  command->callback([command, a] { convert(*command, *a); });
}

}  // namespace weir
