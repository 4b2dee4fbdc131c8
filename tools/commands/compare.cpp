// weir compare: the exact error of a NanoVDB file against its source.
#include <spdlog/spdlog.h>
#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "compressor/compare/compare.h"
#include "compressor/derived/derived_error.h"
#include "compressor/derived/vector_error.h"
#include "compressor/options/conversion_request.h"
#include "compressor/plan/memory_plan.h"
#include "format/base/error.h"
#include "format/base/json_text.h"
#include "format/base/seconds_since.h"
#include "format/base/share_text.h"
#include "format/base/text.h"
#include "format/io/file_id.h"
#include "format/io/file_system.h"
#include "format/nanovdb/nvdb_file.h"
#include "format/process/process_memory.h"
#include "format/sidecar/find_sidecar.h"
#include "format/sidecar/sidecar.h"
#include "format/sidecar/valid_voxels.h"
#include "ingest/plan/staging.h"
#include "ingest/source/source_view.h"
#include "ingest/source_registry.h"
#include "ingest/values/axis_placement.h"
#include "tools/command.h"
#include "tools/command_request.h"
#include "tools/options/run_options.h"
#include "tools/options/table_options.h"
#include "tools/options/trace_option.h"
#include "tools/report/derived_report.h"
#include "tools/report/error_text.h"
#include "tools/report/foreign_file.h"
#include "tools/report/json_loss.h"
#include "tools/report/recorded_input.h"
#include "tools/report/vector_report.h"
#include "tools/spectrum/power_spectrum.h"
#include "tools/spectrum/spectrum_file.h"
#include "tools/spectrum/spectrum_report.h"

namespace weir {
namespace {

/// Memory for pages of the mapped file between two releases, stacks and the blocks' overhead.
constexpr std::uint64_t kCompareBytes = std::uint64_t{56} << 20U;
constexpr std::uint64_t kLeastBlockBytes = std::uint64_t{1} << 20U;
/// Larger blocks are not faster.
constexpr std::uint64_t kMostBlockBytes = std::uint64_t{256} << 20U;

struct CompareArguments {
  std::string input;
  std::string volume;
  GivenOptions options;
  ProgressOptions progress;
  std::string trace;
  bool json = false;
  bool derived = false;
  std::string spectrum;             ///< output file; empty: not asked for
  std::vector<std::string> vector;  ///< source and file of the second and third component; empty: not asked for

  /// Returns whether the size of a voxel matters for what is asked.
  bool asks_for_lengths() const { return derived || !spectrum.empty() || !vector.empty(); }
};

/// Two blocks of the source are held at a time. Derived errors and spectra also hold a block of decoded values; each
/// block with its surroundings may be twice as large. Each thread counts errors in a histogram, or transforms a block.
constexpr std::uint64_t kHistogramBytes = std::uint64_t{600} << 10U;
constexpr std::uint64_t kBlocks = 2;
constexpr std::uint64_t kBlocksOfDerived = 6;
/// With --vector: two more for each other component.
constexpr std::uint64_t kBlocksOfVector = 14;

std::uint64_t block_bytes(std::uint64_t memory, std::uint64_t source_bytes, std::uint64_t blocks) {
  const std::uint64_t fixed = resident_bytes() + source_bytes + kStagingBytes + kCompareBytes;
  if (memory < fixed + blocks * kLeastBlockBytes) {
    throw Error(ErrorKind::usage, cat("--memory ", format_bytes(memory), " is too small; give at least ",
                                      ((fixed + blocks * kLeastBlockBytes) >> 20U) + 1, "MiB"));
  }
  return std::min((memory - fixed) / blocks, kMostBlockBytes);
}

/// A file, and its source as the file's sidecar and the options say it was read.
struct ComparedPair {
  NvdbFile file;
  std::unique_ptr<VolumeSource> source;
};

/// Returns `source` with the voxel size of `file`, unless an option gave a voxel size. Lengths are then those of the
/// conversion, whether or not the source names any, with or without a sidecar.
std::unique_ptr<VolumeSource> with_voxel_size(std::unique_ptr<VolumeSource> source, const NvdbFile& file,
                                              const SourceOptions& options) {
  SourceOptions place;
  place.spacing = file.grid().voxel_size();
  if (options.spacing || source->info().spacing == *place.spacing) return source;
  spdlog::info("{}: taken with --spacing {}, the voxel size of {}", source->info().path, vector_text(*place.spacing),
               file.path());
  return place_source(std::move(source), place);
}

ComparedPair open_pair(const std::string& input, const std::string& volume, const CompareArguments& arguments) {
  if (is_foreign_file(volume)) {
    throw input_error(volume, "is no NanoVDB file; give the source first, then the .nvdb file made of it");
  }
  NvdbFile file(volume);
  file.mapping().release_pages();  // pages that the validation read
  SourceOptions options = command_request(arguments.options).source;
  const InputRecord record = read_input_record(file);
  if (!record.unusable.empty()) spdlog::warn("{}", record.unusable);
  if (const std::string taken = take_recorded_input(input, record, arguments.options, options); !taken.empty()) {
    spdlog::info("{}: read with {}, as {} records", input, taken, record.path);
  }
  std::unique_ptr<VolumeSource> source = open_source(input, options);
  if (arguments.asks_for_lengths()) source = with_voxel_size(std::move(source), file, options);
  if (const std::string other = other_input_note(record, source->info()); !other.empty()) {
    spdlog::warn("{}: {}", volume, other);
  }
  if (const std::string changed = changed_source_note(record, source->info()); !changed.empty()) {
    spdlog::warn("{}: {}; the figures compare with what it is now", input, changed);
  }
  return {std::move(file), std::move(source)};
}

/// Opens the pair of INPUT and OUT.nvdb, then the pairs of --vector.
std::vector<ComparedPair> open_pairs(const CompareArguments& a) {
  std::vector<ComparedPair> pairs;
  pairs.push_back(open_pair(a.input, a.volume, a));
  for (std::size_t i = 0; i < a.vector.size(); i += 2) {
    pairs.push_back(open_pair(a.vector[i], a.vector[i + 1], a));
  }
  return pairs;
}

std::uint64_t block_bytes(const CompareArguments& arguments, const ConversionOptions& run,
                          const std::vector<ComparedPair>& pairs) {
  std::uint64_t each = arguments.derived ? kHistogramBytes : 0;
  if (!arguments.spectrum.empty()) each = std::max(each, kSpectrumThreadBytes);
  std::uint64_t others = processors_or_all(run.threads) * each + (pairs.size() - 1) * kStagingBytes;
  for (const ComparedPair& pair : pairs) others += pair.source->working_bytes();
  return block_bytes(run.memory, others, pairs.size() > 1 ? kBlocksOfVector : each > 0 ? kBlocksOfDerived : kBlocks);
}

/// The optional results besides the comparison.
struct Besides {
  std::optional<DerivedErrors> derived;
  std::optional<PowerSpectrum> spectrum;
  std::optional<VectorErrors> vector;
};

nlohmann::ordered_json to_json(const CompareArguments& arguments, const Comparison& c, const Besides& besides,
                               double total_s) {
  using Json = nlohmann::ordered_json;
  const Certificate& e = c.error;
  Json report;
  report["mse"] = e.mse;
  report["rmse"] = e.rmse;
  report["nmse"] = e.nmse;
  report["psnr_db"] = e.psnr_db ? Json(*e.psnr_db) : Json();
  report["max_abs"] = e.max_abs;
  report["lossless"] = e.lossless;
  report["max_abs_at"] = c.max_abs_at ? Json{c.max_abs_at->x, c.max_abs_at->y, c.max_abs_at->z} : Json();
  report["voxels"] = c.voxels;
  report["finite"] = c.finite;
  report["nonfinite"] = c.nonfinite;
  report["nonfinite_decoded"] = c.nonfinite_decoded;
  report["different"] = c.different;
  report["nonfinite_different"] = c.nonfinite_different;
  report["missing"] = c.missing + c.loss.unmarked;  // left out of the error, or compared as data: the sidecar's count
  report["zeros"] = c.zeros;
  report["zeros_lost"] = c.zeros_lost;
  report["conversion_loss"] = loss_json(c.loss);
  report["value_range"] = c.range ? Json{c.range->min, c.range->max} : Json();
  if (besides.derived) report["derived"] = derived_json(*besides.derived);
  if (besides.spectrum) report["spectrum"] = spectrum_json(*besides.spectrum);
  if (besides.vector) report["vector"] = vector_json(*besides.vector);
  report["source"] = arguments.input;
  report["volume"] = arguments.volume;
  report["total_s"] = total_s;
  report["peak_rss_bytes"] = peak_resident_bytes();
  return report;
}

double extent_of(const std::optional<MinMax>& range) {
  return range ? static_cast<double>(range->max) - static_cast<double>(range->min) : 0;
}

void print_text(const Comparison& c, const std::string& units) {
  const Certificate& e = c.error;
  const char* const counted = c.missing > 0 ? " valid" : " finite";
  if (e.lossless) {
    std::cout << cat(c.nonfinite_different == 0 ? "lossless: all " : "lossless over valid voxels: all ", c.finite,
                     counted, " voxels read bit for bit\n");
  } else {
    std::cout << cat("mse        ", short_number(e.mse), "\nrmse       ", short_number(e.rmse), "\nnmse       ",
                     short_number(e.nmse), '\n');
    if (e.psnr_db) std::cout << cat("psnr       ", short_number(*e.psnr_db), " dB\n");
    std::cout << cat("max abs    ", largest_error_text(e.max_abs, extent_of(c.range), units));
    if (c.max_abs_at) std::cout << cat(" at ", c.max_abs_at->x, ',', c.max_abs_at->y, ',', c.max_abs_at->z);
    std::cout << cat("\ndifferent  ", c.different, " of ", c.finite, counted, " voxels\n");
  }
  if (c.zeros_lost > 0) std::cout << cat("zeros      ", lost_zeros_text(c.zeros_lost, c.zeros), '\n');
  if (c.missing > 0) {
    std::cout << cat("missing    ", c.missing, " of ", c.voxels, " voxels (", share_text(c.missing, c.voxels),
                     c.missing == 1 ? ") holds" : ") hold", " no data, left out of the error\n");
  }
  if (c.nonfinite > c.missing) {
    std::cout << cat("not finite ", c.nonfinite - c.missing, " voxels of the source, left out of the error; ",
                     c.nonfinite_different - c.missing_different, " of them read differently\n");
  }
  if (c.nonfinite_decoded > 0) {
    std::cout << cat("not finite ", c.nonfinite_decoded,
                     " voxels of the file where the source is finite, left out of the error\n");
  }
}

void print(const CompareArguments& arguments, const Comparison& comparison, const Besides& besides,
           const std::string& units, double total_s) {
  if (arguments.json) {
    std::cout << json_text(to_json(arguments, comparison, besides, total_s)) << '\n';
    return;
  }
  print_text(comparison, units);
  if (besides.derived) std::cout << derived_text(*besides.derived, extent_of(comparison.range), units);
  if (besides.spectrum) std::cout << spectrum_text(*besides.spectrum);
  if (besides.vector) std::cout << vector_text(*besides.vector, units);
}

void warn_of_loss(const std::string& input, const ConversionLoss& loss) {
  if (loss.inexact > 0) {
    spdlog::warn("{}: {} values are not representable in float32 and count as rounded, by up to {}", input,
                 loss.inexact, short_number(loss.max_abs_error));
  }
  if (loss.overflow > 0) {
    spdlog::warn("{}: {} values are finite but beyond float32, and count as infinite", input, loss.overflow);
  }
}

// The passes over one volume and its source, or over the three components of a vector field.
class ComparePasses {
 public:
  // `pairs` and `trace` must outlive the object.
  ComparePasses(const CompareArguments& arguments, const std::vector<ComparedPair>& pairs, std::uint64_t block_bytes,
                Trace* trace)
      : arguments_(arguments), pairs_(pairs), progress_(arguments.progress) {
    options_.block_bytes = block_bytes;
    options_.cancel = &interrupt_flag();
    options_.release_pages = [&pairs] {
      for (const ComparedPair& pair : pairs) pair.file.mapping().release_pages();
    };
    options_.trace = trace;
    options_.progress = [this](std::uint64_t done) { progress_.update(done); };
  }

  Comparison compare() {
    return pass("compare", [&] { return compare_volumes(source(), grid(), arguments_.volume, options_); });
  }

  Besides besides(const Comparison& comparison, std::optional<SpectrumFile>& spectrum_file) {
    Besides besides;
    if (arguments_.derived) {
      besides.derived = pass("derived", [&] { return derive_errors(source(), grid(), comparison, options_); });
    }
    if (spectrum_file) {
      besides.spectrum = pass("spectrum", [&] { return power_spectrum(source(), grid(), options_); });
      spectrum_file->write(*besides.spectrum, std::filesystem::path(arguments_.volume).filename().string());
    }
    if (pairs_.size() == 3) {
      const auto component = [&](std::size_t i) { return PairedVolume{*pairs_[i].source, pairs_[i].file.grid()}; };
      besides.vector = pass("vectors", [&] {
        return vector_errors({{component(0), component(1), component(2)}}, options_);
      });
    }
    return besides;
  }

 private:
  VolumeSource& source() const { return *pairs_.front().source; }
  const NvdbGrid& grid() const { return pairs_.front().file.grid(); }

  template <typename Run>
  std::invoke_result_t<const Run&> pass(const char* name, const Run& run) {
    progress_.start(name, static_cast<std::uint64_t>(source().info().domain().voxels()) * sizeof(float));
    auto result = run();
    progress_.finish();
    return result;
  }

  const CompareArguments& arguments_;
  const std::vector<ComparedPair>& pairs_;
  Progress progress_;
  CompareOptions options_;
};

// Returns the paths of all compared files and of their sidecars.
std::vector<std::string> input_paths(const CompareArguments& arguments) {
  std::vector<std::string> paths{arguments.input, arguments.volume, find_sidecar(arguments.volume)};
  for (const std::string& path : arguments.vector) {
    paths.push_back(path);
    paths.push_back(find_sidecar(path));
  }
  return paths;
}

void compare(const CompareArguments& arguments) {
  const auto start = std::chrono::steady_clock::now();
  const ConversionOptions run = read_conversion_request(arguments.options).conversion;
  if (run.scene) {
    spdlog::info(
        "{}: changes no figure: they are of all voxels; weir inspect tells the error of what the conversion's "
        "scene shows",
        run.scene->path);
  }
  const auto threads = limit_threads(run.threads);
  const auto files = make_posix_file_system();
  std::optional<SpectrumFile> spectrum_file;
  if (!arguments.spectrum.empty()) {
    require_not_input(file_ids(input_paths(arguments)), arguments.spectrum);
    spectrum_file.emplace(*files, arguments.spectrum);
  }
  const std::vector<ComparedPair> pairs = open_pairs(arguments);
  std::vector<std::string> paths = input_paths(arguments);
  paths.push_back(arguments.spectrum);
  const std::unique_ptr<Trace> trace = open_trace(arguments.trace, paths);
  ComparePasses passes(arguments, pairs, block_bytes(arguments, run, pairs), trace.get());
  const Comparison comparison = passes.compare();
  const Besides besides = passes.besides(comparison, spectrum_file);
  if (trace) trace->close();
  warn_of_loss(arguments.input, comparison.loss);
  print(arguments, comparison, besides, pairs.front().source->info().units, seconds_since(start));
}

}  // namespace

void add_compare(CLI::App& app) {
  auto arguments = std::make_shared<CompareArguments>();
  CLI::App* command = app.add_subcommand("compare", "Computes the exact error of a volume against its source");
  command->add_option("input", arguments->input, "the source")->type_name("INPUT")->required();
  command->add_option("volume", arguments->volume, "the .nvdb file made from it")->type_name("OUT.nvdb")->required();
  add_input_options_of_one(*command, arguments->options);
  OptionRow levels = conversion_option("levels");
  levels.help = "of an AMReX plotfile: separate where the file is of one level, which its sidecar names";
  levels.standard = "as the sidecar says";
  add_option(*command, levels, arguments->options, "Input");
  OptionRow nonfinite = conversion_option("nonfinite");
  nonfinite.help =
      "as at the conversion; changes no figure: voxels without a number are left out of the error, and counted";
  nonfinite.standard = {};
  add_option(*command, nonfinite, arguments->options, "Input");
  OptionRow scene = conversion_option("scene");
  scene.help = "as at the conversion; is read, and changes no figure: they are of all voxels";
  add_option(*command, scene, arguments->options, "Input");
  add_run_options(*command, arguments->options, arguments->progress);
  add_trace_option(*command, arguments->trace);
  command->add_flag("--derived", arguments->derived,
                    "also quantiles of |error|, the error of the gradient and structural similarity; reads both twice");
  command
      ->add_option(
          "--spectrum", arguments->spectrum,
          "also the power of source, file and error by wave number: a chart, FILE.png or FILE.svg, or a table, "
          "FILE.csv, which replaces one that is there; reads both once more")
      ->type_name("FILE");
  command
      ->add_option("--vector", arguments->vector,
                   "also the errors of vorticity and divergence of the field whose first component INPUT and OUT.nvdb "
                   "are: sources and files of the second and of the third one; reads all once more")
      ->type_name("V V.nvdb W W.nvdb")
      ->expected(4);
  command->add_flag(
      "--json", arguments->json,
      "one JSON object on stdout; its lossless is of the finite voxels, and nonfinite_different counts the others "
      "that read differently");
  add_log_level(*command);
  command->footer(
      "Where the sidecar lies beside the volume, the dataset, index, component, region, spacing and treatment of "
      "missing\n"
      "values of the conversion are taken from it, unless they are given. What is derived is per world unit of the\n"
      "volume's own voxel size, unless --spacing is given.");
  command->callback([arguments] { compare(*arguments); });
}

}  // namespace weir
