// weir compare: the exact error of a NanoVDB file against its source.
#include <spdlog/spdlog.h>
#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <chrono>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "compressor/compare.h"
#include "compressor/options/conversion_request.h"
#include "format/base/error.h"
#include "format/base/process_memory.h"
#include "format/base/seconds_since.h"
#include "format/base/text.h"
#include "format/nanovdb/nvdb_file.h"
#include "format/sidecar/sidecar.h"
#include "ingest/plan/staging.h"
#include "ingest/source_registry.h"
#include "tools/command.h"
#include "tools/options/run_options.h"
#include "tools/options/table_options.h"
#include "tools/options/trace_option.h"

namespace weir {
namespace {

/// Leaves of the mapped file between two releases, stacks, the blocks' own waste.
constexpr std::uint64_t kCompareBytes = std::uint64_t{56} << 20U;
constexpr std::uint64_t kLeastBlockBytes = std::uint64_t{1} << 20U;
/// Larger blocks are no faster.
constexpr std::uint64_t kMostBlockBytes = std::uint64_t{256} << 20U;

struct CompareArguments {
  std::string input;
  std::string volume;
  GivenOptions options;
  ProgressOptions progress;
  std::string trace;
  bool json = false;
};

std::uint64_t block_bytes(std::uint64_t memory, std::uint64_t source_bytes) {
  const std::uint64_t fixed = resident_bytes() + source_bytes + kStagingBytes + kCompareBytes;
  if (memory < fixed + 2 * kLeastBlockBytes) {
    throw Error(ErrorKind::usage, cat("--memory ", format_bytes(memory), " is too small; give at least ",
                                      ((fixed + 2 * kLeastBlockBytes) >> 20U) + 1, "MiB"));
  }
  return std::min((memory - fixed) / 2, kMostBlockBytes);
}

nlohmann::ordered_json to_json(const CompareArguments& arguments, const Comparison& c, double total_s) {
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
  report["value_range"] = c.range ? Json{c.range->min, c.range->max} : Json();
  report["source"] = arguments.input;
  report["volume"] = arguments.volume;
  report["total_s"] = total_s;
  report["peak_rss_bytes"] = peak_resident_bytes();
  return report;
}

void print_text(const Comparison& c) {
  const Certificate& e = c.error;
  if (e.lossless) {
    std::cout << cat("lossless: all ", c.finite, " finite voxels read bit for bit\n");
  } else {
    std::cout << cat("mse        ", e.mse, "\nrmse       ", e.rmse, "\nnmse       ", e.nmse, '\n');
    if (e.psnr_db) std::cout << cat("psnr       ", *e.psnr_db, " dB\n");
    std::cout << cat("max abs    ", e.max_abs);
    if (c.max_abs_at) std::cout << cat(" at ", c.max_abs_at->x, ',', c.max_abs_at->y, ',', c.max_abs_at->z);
    std::cout << cat("\ndifferent  ", c.different, " of ", c.finite, " finite voxels\n");
  }
  if (c.nonfinite > 0) {
    std::cout << cat("not finite ", c.nonfinite, " voxels of the source, left out of the error; ",
                     c.nonfinite_different, " of them read differently\n");
  }
  if (c.nonfinite_decoded > 0) {
    std::cout << cat("not finite ", c.nonfinite_decoded, " voxels of the file where the source is finite\n");
  }
}

void compare(const CompareArguments& arguments) {
  const auto start = std::chrono::steady_clock::now();
  auto [source_options, run] = read_conversion_request(arguments.options);
  const auto threads = limit_threads(run.threads);
  const auto source = open_source(arguments.input, source_options);
  const NvdbFile file(arguments.volume);
  file.mapping().release_pages();  // what its validation looked at

  CompareOptions options;
  options.block_bytes = block_bytes(run.memory, source->working_bytes());
  options.cancel = &interrupt_flag();
  options.release_pages = [&] { file.mapping().release_pages(); };
  const std::unique_ptr<Trace> trace =
      open_trace(arguments.trace, std::array{arguments.input, arguments.volume, sidecar_path(arguments.volume)});
  options.trace = trace.get();
  Progress progress(arguments.progress);
  progress.start("compare", static_cast<std::uint64_t>(source->info().domain().voxels()) * sizeof(float));
  options.progress = [&](std::uint64_t done) { progress.update(done); };
  const Comparison comparison = compare_volumes(*source, file.grid(), arguments.volume, options);
  progress.finish();
  if (trace) trace->close();

  if (comparison.loss.inexact > 0) {
    spdlog::warn("{}: {} values are not representable in float32 and count as rounded, by up to {}", arguments.input,
                 comparison.loss.inexact, comparison.loss.max_abs_error);
  }
  const double total_s = seconds_since(start);
  if (arguments.json) {
    std::cout << to_json(arguments, comparison, total_s).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)
              << '\n';
  } else {
    print_text(comparison);
  }
}

}  // namespace

void add_compare(CLI::App& app) {
  auto arguments = std::make_shared<CompareArguments>();
  CLI::App* command = app.add_subcommand("compare", "Computes the exact error of a volume against its source");
  command->add_option("input", arguments->input, "the source")->type_name("INPUT")->required();
  command->add_option("volume", arguments->volume, "the .nvdb file made from it")->type_name("OUT.nvdb")->required();
  add_input_options(*command, arguments->options);
  add_run_options(*command, arguments->options, arguments->progress);
  add_trace_option(*command, arguments->trace);
  command->add_flag("--json", arguments->json, "one JSON object on stdout");
  add_log_level(*command);
  command->callback([arguments] { compare(*arguments); });
}

}  // namespace weir
