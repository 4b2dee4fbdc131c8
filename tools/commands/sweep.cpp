// weir sweep: measures error, size and time against rate for weir's methods, the paper's method and ZFP.
#include <oneapi/tbb/global_control.h>
#include <spdlog/spdlog.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <iostream>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "compressor/build_commit.h"
#include "compressor/conversion.h"
#include "compressor/options/conversion_request.h"
#include "compressor/select/file_size.h"
#include "format/base/error.h"
#include "format/base/printable.h"
#include "format/base/seconds_since.h"
#include "format/base/text.h"
#include "format/output/partial_file.h"
#include "format/process/process_memory.h"
#include "ingest/drivers/driver.h"
#include "ingest/source_registry.h"
#include "tools/command.h"
#include "tools/command_request.h"
#include "tools/options/given_options.h"
#include "tools/options/result_directory.h"
#include "tools/options/run_options.h"
#include "tools/options/table_options.h"
#include "tools/report/volume_title.h"
#include "tools/sweep/sweep_method.h"
#include "tools/sweep/sweep_plot.h"
#include "tools/sweep/sweep_report.h"
#include "tools/sweep/zfp_codec.h"
#include "tools/sweep/zfp_trial.h"

namespace weir {
namespace {

using Clock = std::chrono::steady_clock;

/// The command line as given; empty: not given.
struct SweepArguments {
  std::string input;
  std::string rates = "20,10,8,5,4,2";
  std::string methods = has_zfp() ? "auto,float,paper,zfp" : "auto,float,paper";
  std::string output;
  GivenOptions options;
  ProgressOptions progress;
  bool keep = false;
  bool overwrite = false;
  bool json = false;
};

std::string volume_name(const SweepMethod& method, double rate) { return cat(method.name, "_rate", rate, ".nvdb"); }

// Checks all outputs before the work, so that no refusal comes after minutes of work.
void check_outputs(const ResultDirectory& directory, std::span<const SweepMethod> methods,
                   std::span<const double> rates, const SweepArguments& a) {
  std::vector<std::string> paths;
  for (const char* name :
       {"sweep.csv", "sweep.json", "psnr_bits.png", "psnr_bits.svg", "psnr_seconds.png", "psnr_seconds.svg"}) {
    paths.push_back(directory / name);
  }
  for (const SweepMethod& method : methods) {
    if (method.is_zfp()) continue;
    for (const double rate : rates) {
      paths.push_back(directory / volume_name(method, rate));
      paths.push_back(sidecar_path(paths.back()));
    }
  }
  std::error_code ignored;
  for (const std::string& path : paths) {
    if (std::filesystem::equivalent(a.input, path, ignored)) {
      throw usage_error(cat(path, ": is the input; choose another directory with -o"));
    }
    if (std::filesystem::is_directory(path, ignored)) {
      throw usage_error(cat(path, ": is a directory; choose another one with -o"));
    }
    if (!a.overwrite && std::filesystem::exists(path, ignored)) {
      throw usage_error(cat(path, ": exists; choose another directory with -o or pass --overwrite"));
    }
  }
}

class Sweep {
 public:
  Sweep(VolumeSource& source, const ResultDirectory& directory, FileSystem& files, const SweepArguments& arguments,
        std::map<std::string, std::string> given)
      : source_(source),
        directory_(directory),
        files_(files),
        arguments_(arguments),
        given_(std::move(given)),
        run_(read_conversion_request(arguments.options).conversion) {}

  SweepRow run(const SweepMethod& method, double rate) {
    SweepRow row;
    row.method = method.name;
    row.rate = rate;
    row.bytes_asked = bytes_at_rate(static_cast<std::uint64_t>(volume(source_.info().extent)) * sizeof(float), rate);
    Progress progress(arguments_.progress);
    ConversionControl control;
    control.cancel = &interrupt_flag();
    control.pass_started = [&](const std::string& pass, std::uint64_t bytes) {
      progress.start(cat(method.name, " at rate ", rate, ", ", pass), bytes);
    };
    control.pass_advanced = [&](std::uint64_t done) { progress.update(done); };
    if (method.is_zfp()) {
      run_zfp(control, row);
    } else {
      run_conversion(method, control, row);
    }
    progress.finish();
    return row;
  }

 private:
  // Removes remedies from a note, because they name options of weir convert.
  static std::string without_remedy(std::string note) {
    for (const char* const remedy : {"; ask for --size", ", which --at-most leaves out"}) {
      note.resize(std::min(note.find(remedy), note.size()));
    }
    return note;
  }

  void run_conversion(const SweepMethod& method, ConversionControl& control, SweepRow& row) {
    ConversionOptions options = conversion_of(method, arguments_.options);
    // A volume that is not kept gets its own name, so that it replaces nothing that an earlier sweep kept.
    const std::string name = volume_name(method, row.rate);
    options.output = directory_ / (arguments_.keep ? name : cat(".unkept_", name));
    options.overwrite = arguments_.overwrite || !arguments_.keep;
    options.budget = {Budget::Kind::rate, row.rate, 0};
    options.memory = run_.memory;
    options.resume = Resume::off;  // an interrupted volume is not kept; only the rows of the report are
    options.threads = run_.threads;
    options.provenance = {WEIR_VERSION, build_commit(), given_};
    options.provenance.options.insert(method.options.begin(), method.options.end());
    options.provenance.options["rate"] = cat(row.rate);
    // A conversion's notice about its file belongs to the row. A notice about the source or the disk is logged once.
    const std::string own = options.output + ": ";
    const auto is_own = [&own](const std::string& line) { return line.compare(0, own.size(), own) == 0; };
    control.notice = [&](const Message& message) {
      const std::string line = message.text();
      if (is_own(line)) {
        row.note = without_remedy(line.substr(own.size()));
      } else if (said_.insert(line).second) {
        spdlog::warn("{}", line);
      }
    };
    const Clock::time_point start = Clock::now();
    try {
      const Sidecar made = convert_volume(source_, options, control, files_);
      SweepResult result;
      result.seconds = seconds_since(start);
      result.encoding = made.packed ? "packed" : made.grid.type;
      result.bytes = made.file.bytes;
      result.error = {made.error.mse,     made.error.rmse,    made.error.nmse,
                      made.error.psnr_db, made.error.max_abs, made.error.lossless};
      result.leaves_kept = made.selection.leaves_kept;
      result.loss = made.conversion_loss;
      take_result(result, row);
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::budget) throw;
      const std::string line = error.what();
      row.note = without_remedy(is_own(line) ? line.substr(own.size()) : line);
      return;
    }
    if (!arguments_.keep) {
      files_.remove(options.output);
      files_.remove(sidecar_path(options.output));
    }
  }

  void run_zfp(const ConversionControl& control, SweepRow& row) {
    const auto block_bits = zfp_block_bits(source_.info().extent, row.bytes_asked);
    if (!block_bits) {
      row.note =
          cat(row.bytes_asked, " bytes asked, ZFP takes ", zfp_stream_bytes(source_.info().extent, kLeastZfpBits),
              " or more: ", kLeastZfpBits, " bits a block of 4^3 voxels");
      return;
    }
    ZfpTrialOptions options;
    options.block_bits = *block_bits;
    options.memory = run_.memory;
    options.directory = directory_.path();
    const ZfpTrial trial = try_zfp(source_, options, control, files_);
    if (trial.nonfinite > 0 || trial.nonfinite_decoded > 0) {
      row.note = trial.nonfinite > 0
                     ? cat("ZFP has no code for NaN and infinity, which ", trial.nonfinite, " voxels are")
                     : cat("what ZFP gives back overflows float32 in ", trial.nonfinite_decoded, " voxels");
      return;
    }
    const ConversionLoss& loss = trial.loss;
    take_result({"zfp",
                 trial.bytes,
                 trial.error,
                 trial.seconds,
                 std::nullopt,
                 {loss.inexact, loss.overflow, loss.max_abs_error}},
                row);
  }

  static void take_result(const SweepResult& result, SweepRow& row) {
    row.result = result;
    if (const std::string lost = loss_note(result); !lost.empty()) row.note += (row.note.empty() ? "" : "; ") + lost;
  }

  VolumeSource& source_;
  const ResultDirectory& directory_;
  FileSystem& files_;
  const SweepArguments& arguments_;
  std::map<std::string, std::string> given_;
  ConversionOptions run_;
  std::set<std::string> said_;
};

void write_text(FileSystem& files, const std::string& path, const std::string& text, bool overwrite) {
  PartialFile file(files, path, overwrite);
  file.file().write_at(0, std::as_bytes(std::span(text)));
  file.commit();
}

constexpr std::array kCharts{std::pair{"psnr_bits", SweepAxis::bits_per_voxel},
                             std::pair{"psnr_seconds", SweepAxis::seconds}};

/// Draws the charts. Without a driver for charts, the charts of an earlier sweep are removed, because they do not
/// match this sweep.
void draw_charts(FileSystem& files, const ResultDirectory& directory, const SweepReport& report, bool can_draw) {
  for (const auto& [name, axis] : kCharts) {
    for (const char* ending : {".png", ".svg"}) {
      const std::string path = directory / cat(name, ending);
      if (can_draw) {
        write_text(files, path, psnr_chart(report, axis, plot_format(path, "output")), true);
      } else if (files.exists(path)) {
        files.remove(path);
      }
    }
  }
}

// Returns the error of an interrupted sweep. With --keep, finished volumes stay.
Error interrupted_sweep(const SweepReport& report, const SweepArguments& a) {
  const auto volumes =
      std::ranges::count_if(report.rows, [](const SweepRow& row) { return row.result && row.result->leaves_kept; });
  if (!a.keep || volumes == 0) return {ErrorKind::interrupted, "interrupted; no results were written"};
  return {ErrorKind::interrupted,
          cat("interrupted; no report was written, and ", volumes, volumes == 1 ? " volume is" : " volumes are",
              " kept in ", a.output, "; choose another directory with -o or pass --overwrite to begin anew")};
}

// Returns whether charts can be drawn. If the driver is missing, a warning names the remedy and the rest of the sweep
// is done.
bool can_draw_charts(const std::string& output) {
  try {
    load_driver("plot", output + ": no charts are drawn");
    return true;
  } catch (const Error& error) {
    spdlog::warn("{}", error.what());
    return false;
  }
}

void sweep(const CLI::App& command, const SweepArguments& a) {
  const Clock::time_point start = Clock::now();
  const std::vector<double> rates = parse_rates(a.rates);
  const std::vector<SweepMethod> methods = parse_sweep_methods(a.methods);
  for (const SweepMethod& method : methods) conversion_of(method, a.options);
  auto [source_options, run] = command_request(a.options);
  source_options.spool_directory = a.output;
  const auto threads = limit_threads(run.threads);
  const auto files = make_posix_file_system();
  const ResultDirectory directory(*files, a.output);
  check_outputs(directory, methods, rates, a);
  const bool can_draw = can_draw_charts(a.output);
  const std::unique_ptr<VolumeSource> source = open_source(a.input, source_options);

  std::map<std::string, std::string> given = given_options(command, a.options);
  for (const char* own : {"rates", "methods", "output", "keep"}) given.erase(own);
  Sweep sweep(*source, directory, *files, a, given);
  SweepReport report;
  report.source = a.input;
  const SourceInfo& info = source->info();
  report.chosen = printable(chosen_text(info.dataset, info.index, info.details.component));
  report.extent = info.extent;
  report.threads = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  report.memory = source_options.memory;
  try {
    for (const SweepMethod& method : methods) {
      for (const double rate : rates) report.rows.push_back(sweep.run(method, rate));
    }
  } catch (const Error& error) {
    throw error.kind() == ErrorKind::interrupted ? interrupted_sweep(report, a) : error;
  }
  report.total_s = seconds_since(start);
  report.peak_rss_bytes = peak_resident_bytes();

  write_text(*files, directory / "sweep.csv", csv_text(report), a.overwrite);
  write_text(*files, directory / "sweep.json", json_text(report), a.overwrite);
  draw_charts(*files, directory, report, can_draw);
  std::cout << (a.json ? json_text(report) : table_text(report));
}

}  // namespace

void add_sweep(CLI::App& app) {
  auto a = std::make_shared<SweepArguments>();
  CLI::App* command =
      app.add_subcommand("sweep", "Measures error, size and time against rate, ZFP's and the paper's too");
  command->add_option("input", a->input, "volume file, NAME_XxYxZ_TYPE.raw for instance")
      ->type_name("INPUT")
      ->required();
  command
      ->add_option("-o,--output", a->output,
                   "directory for sweep.csv, sweep.json, and charts, psnr_bits and psnr_seconds, as .png and .svg")
      ->type_name("DIR")
      ->required();
  command->add_option("--rates", a->rates, "dense float32 bytes / file bytes, between commas")
      ->type_name("R,R,...")
      ->capture_default_str();
  command->add_option("--methods", a->methods, cat("between commas, of ", sweep_method_names()))
      ->type_name("METHOD,...")
      ->capture_default_str();
  add_option(*command, conversion_option("nonfinite"), a->options);
  command->add_flag("--keep", a->keep, "keep the converted volumes, METHOD_rateRATE.nvdb, in the directory");
  command->add_flag("--overwrite", a->overwrite, "replace existing results");
  add_input_options_of_one(*command, a->options);
  add_run_options(*command, a->options, a->progress);
  command->add_flag("--json", a->json, "print what is in sweep.json on stdout");
  add_log_level(*command);
  command->callback([command, a] { sweep(*command, *a); });
}

}  // namespace weir
