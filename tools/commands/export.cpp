// weir export: writes a NanoVDB file as an OpenVDB file, for programs that read only OpenVDB.
#include <spdlog/spdlog.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <chrono>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "compressor/damaged_input.h"
#include "compressor/options/conversion_request.h"
#include "format/base/error.h"
#include "format/base/json_text.h"
#include "format/base/printable.h"
#include "format/base/seconds_since.h"
#include "format/base/text.h"
#include "format/io/file_id.h"
#include "format/io/real_path.h"
#include "format/layout/nanovdb_layout.h"
#include "format/nanovdb/nvdb_file.h"
#include "format/output/partial_file.h"
#include "format/process/process_memory.h"
#include "format/sidecar/find_sidecar.h"
#include "format/sidecar/is_of.h"
#include "format/sidecar/read_sidecar.h"
#include "format/sidecar/valid_voxels.h"
#include "ingest/vdb/openvdb_library.h"
#include "ingest/vdb/vdb_header.h"
#include "tools/command.h"
#include "tools/export/vdb_writer.h"
#include "tools/options/run_options.h"
#include "tools/report/foreign_file.h"

namespace weir {
namespace {

/// Memory for a batch of leaves (mapped, decoded and compressed), the output's buffer and stacks.
constexpr std::uint64_t kExportBytes = std::uint64_t{24} << 20U;

struct ExportArguments {
  std::string volume;
  std::string output;
  std::string compression = "blosc";
  bool half = false;
  bool overwrite = false;
  bool json = false;
  GivenOptions options;
  ProgressOptions progress;
};

std::uint32_t compression_flags(const std::string& name) {
  return name == "blosc" ? kVdbBlosc : name == "zip" ? kVdbZip : 0;
}

// Throws if the memory is too small. Opening the file reads all nodes above the leaves at once.
void require_memory(const NvdbGrid& grid, std::uint64_t memory) {
  const auto [leaves, lower, upper] = grid.node_counts();
  const std::uint64_t needed =
      resident_bytes() + std::max(kExportBytes, lower * nvdb::kLowerBytes + upper * nvdb::kUpperBytes);
  if (memory >= needed) return;
  throw Error(ErrorKind::usage,
              cat("--memory ", format_bytes(memory), " is too small; give at least ", (needed >> 20U) + 1, "MiB"));
}

// Returns the sidecar of this volume; nullopt if it is missing, damaged or of another volume.
std::optional<Sidecar> sidecar_of(const NvdbFile& file) {
  const std::string path = find_sidecar(file.path());
  if (!is_there(path)) return std::nullopt;
  try {
    Sidecar sidecar = read_sidecar(path);
    if (is_of(sidecar, file)) return sidecar;
    spdlog::warn("{}: is of another volume than {}; its certificate is left out", path, file.path());
  } catch (const Error& error) {
    spdlog::warn("{}; the certificate is left out", error.what());
  }
  return std::nullopt;
}

VdbMetadata certificate(const Sidecar& sidecar) {
  VdbMetadata metadata{{"weir_version", sidecar.weir.version},
                       {"weir_source_path", sidecar.source.path},
                       {"weir_source_format", sidecar.source.format},
                       {"weir_budget", sidecar.budget.kind},
                       {"weir_rate", sidecar.budget.rate},
                       {"weir_lossless", lossless_everywhere(sidecar)},
                       {"weir_rmse", sidecar.error.rmse},
                       {"weir_max_abs", sidecar.error.max_abs}};
  const auto add = [&](const char* name, const std::string& text) {
    if (!text.empty()) metadata[name] = text;
  };
  add("weir_source_dataset", sidecar.source.dataset);
  add("weir_source_component", sidecar.source.component);
  add("weir_source_long_name", sidecar.source.long_name);
  add("weir_source_units", sidecar.source.units);
  if (sidecar.source.time) {
    metadata["weir_source_time"] = sidecar.source.time->value;
    add("weir_source_time_units", sidecar.source.time->units);
  }
  if (sidecar.budget.requested) metadata["weir_requested"] = *sidecar.budget.requested;
  if (sidecar.error.psnr_db) metadata["weir_psnr_db"] = *sidecar.error.psnr_db;
  return metadata;
}

void warn_of_other_grids(const NvdbFile& file) {
  const std::size_t grids = all_nvdb_segments(file.bytes(), file.path()).size();
  if (grids > 1) {
    spdlog::warn("{}: has {} grids, and only the first, \"{}\", is exported", file.path(), grids, file.grid().name());
  }
}

nlohmann::ordered_json to_json(const ExportArguments& arguments, const NvdbGrid& grid, const VdbWritten& written,
                               std::uint64_t tree_bytes, double total_s) {
  using Json = nlohmann::ordered_json;
  return {{"volume", arguments.volume},
          {"output", arguments.output},
          {"grid", grid.name()},
          {"class", written.level_set ? "level set" : "fog volume"},
          {"compression", arguments.compression},
          {"half", arguments.half},
          {"half_max_abs_error", arguments.half ? Json(written.half_max_abs_error) : Json()},
          {"bytes", written.bytes},
          {"leaves", written.topology.nodes[0]},
          {"active_voxels", written.active_voxels},
          {"tree_bytes", tree_bytes},
          {"total_s", total_s},
          {"peak_rss_bytes", peak_resident_bytes()}};
}

void export_volume(const ExportArguments& arguments) {
  const auto start = std::chrono::steady_clock::now();
  if (!arguments.output.ends_with(".vdb")) {
    throw Error(ErrorKind::usage, cat("--output is \"", arguments.output, "\", it must end in .vdb"));
  }
  const ConversionOptions run = read_conversion_request(arguments.options).conversion;
  const auto threads = limit_threads(run.threads);
  if (const auto id = file_id(arguments.volume)) require_not_input({&*id, 1}, arguments.output);
  refuse_foreign_file(arguments.volume);
  const NvdbFile file(arguments.volume);
  file.mapping().release_pages();  // pages that the validation read
  require_memory(file.grid(), run.memory);
  warn_of_other_grids(file);

  VdbWriterOptions options;
  options.compression = compression_flags(arguments.compression);
  options.half = arguments.half;
  options.creator = cat("weir ", WEIR_VERSION);
  const std::optional<Sidecar> sidecar = sidecar_of(file);
  if (sidecar) options.metadata = certificate(*sidecar);
  Progress progress(arguments.progress);
  const auto advance = [&](std::uint64_t done) {
    progress.update(done);
    if (interrupt_flag()) throw Error(ErrorKind::interrupted, "interrupted");
  };
  const std::uint64_t total = file.grid().data_bytes();
  options.progress = [&](double share) { advance(static_cast<std::uint64_t>(share * static_cast<double>(total))); };
  options.release_pages = [&] { file.mapping().release_pages(); };

  const OpenVdbLibrary& library = openvdb_library(arguments.output + ": is to be an OpenVDB file");
  const std::unique_ptr<FileSystem> files = make_posix_file_system();
  PartialFile output(*files, arguments.output, arguments.overwrite);  // refuses a bad name before everything is read
  if (sidecar) {
    const auto started = [&](std::uint64_t bytes) { progress.start("check", bytes); };
    refuse_damaged(arguments.volume, *sidecar, {{}, started, advance});
  }
  progress.start("export", total);
  const VdbWritten written = write_vdb(file.grid(), arguments.volume, options, output.file());
  progress.finish();
  output.commit();

  const std::uint64_t tree_bytes = library.tree_bytes(*vdb_type("Tree_float_5_4_3"), written.topology);
  if (arguments.json) {
    const auto report = to_json(arguments, file.grid(), written, tree_bytes, seconds_since(start));
    std::cout << json_text(report) << '\n';
    return;
  }
  std::cout << cat(one_line(arguments.output), ": ", format_bytes(written.bytes), ", ", written.topology.nodes[0],
                   " leaves, ", written.active_voxels, " active voxels; a program that loads it takes ",
                   format_bytes(tree_bytes), '\n');
  if (arguments.half) std::cout << cat("largest error of 16 bits: ", written.half_max_abs_error, '\n');
}

}  // namespace

void add_export(CLI::App& app) {
  auto arguments = std::make_shared<ExportArguments>();
  CLI::App* command =
      app.add_subcommand("export", "Writes a volume as an OpenVDB file, for Blender, Houdini, ParaView");
  command->add_option("volume", arguments->volume, "the .nvdb file")->type_name("OUT.nvdb")->required();
  command->add_option("-o,--output", arguments->output, "the OpenVDB file")->type_name("OUT.vdb")->required();
  command->add_flag("--half", arguments->half, "values as 16-bit floats; says the largest error of that");
  command->add_option("--compression", arguments->compression, "of the values; only active ones are stored in any case")
      ->check(CLI::IsMember({"none", "zip", "blosc"}))
      ->capture_default_str();
  command->add_flag("--overwrite", arguments->overwrite, "replace an existing output");
  command->add_flag("--json", arguments->json, "one JSON object on stdout");
  add_run_options(*command, arguments->options, arguments->progress);
  add_log_level(*command);
  command->footer(
      "Values, tiles and active states are those of the volume, bit for bit. The file is written node by node: "
      "--memory\n"
      "80MiB does for 2 x 10^9 voxels, 16 MiB more for each further 10^9. A program that loads it builds OpenVDB's "
      "tree,\n"
      "more than 2 KiB for each leaf; the report says how much that is.");
  command->callback([arguments] { export_volume(*arguments); });
}

}  // namespace weir
