// weir inspect: what a NanoVDB file holds and what its sidecar says about it, or
// what an input holds. Decodes no block unless the histogram has to be counted (no
// sidecar); of a packed file it looks at all directories.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "compressor/options/conversion_request.h"
#include "format/base/error.h"
#include "format/base/text.h"
#include "format/io/file_system.h"
#include "format/io/real_path.h"
#include "format/layout/nanovdb_layout.h"
#include "format/nanovdb/nvdb_checksum.h"
#include "format/nanovdb/nvdb_file.h"
#include "format/nanovdb/nvdb_header.h"
#include "format/output/partial_file.h"
#include "gpu/image/image_output.h"
#include "ingest/drivers/driver.h"
#include "tools/command.h"
#include "tools/options/run_options.h"
#include "tools/options/table_options.h"
#include "tools/report/histogram_plot.h"
#include "tools/report/input_listing.h"
#include "tools/report/packed_census.h"
#include "tools/report/printable.h"
#include "tools/report/progress.h"
#include "tools/report/read_sidecar.h"
#include "tools/report/tree_census.h"

namespace weir {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kBins = 256;  // of a histogram counted here

struct InspectArguments {
  std::string path;
  GivenOptions source;
  std::string plot;
  bool json = false;
  ProgressOptions progress;
};

struct Inspection {
  const NvdbGrid& grid;
  std::optional<Sidecar> sidecar;
  bool sidecar_matches = false;  ///< size and head checksum are those of the volume
  Sidecar::Histogram histogram;
  std::optional<PackedCensus> packed;  ///< where the grid is packed
};

std::string shown_text(const Index3& i) { return cat(i.x, " x ", i.y, " x ", i.z); }
std::string shown_text(const std::array<double, 3>& v) { return cat(v[0], ", ", v[1], ", ", v[2]); }
double two_decimals(double bits) { return std::round(100 * bits) / 100; }
Json json_of(const Index3& i) { return {i.x, i.y, i.z}; }

const char* checksum_state(const NvdbGrid& grid) {
  if (grid.head_checksum() == static_cast<std::uint32_t>(nvdb::kNoChecksum)) return "absent";
  return grid.head_checksum() == computed_head_checksum(grid) ? "ok" : "wrong";
}

Sidecar::Histogram counted_histogram(const NvdbGrid& grid, const ProgressOptions& shown) {
  const float lo = grid.value_min();
  const float hi = grid.value_max();
  Sidecar::Histogram histogram{lo, hi, {}};
  if (!std::isfinite(lo) || !std::isfinite(hi) || !(lo < hi)) return histogram;
  Progress progress(shown);
  progress.start("histogram", grid.data_bytes());
  const auto leaf_bytes = grid.data_bytes() / std::max<std::uint64_t>(census_blocks(grid), 1);
  histogram.counts = count_values(grid, lo, hi, kBins, [&](std::uint64_t leaves) {
    progress.update(leaves * leaf_bytes);
    if (interrupt_flag()) throw Error(ErrorKind::interrupted, "interrupted");
  });
  return histogram;
}

Inspection look_at(const NvdbFile& file, const InspectArguments& arguments) {
  Inspection result{file.grid(), std::nullopt, false, {}, std::nullopt};
  if (const PackedData* packed = file.grid().packed()) result.packed = take_packed_census(*packed);
  const std::string path = sidecar_path(arguments.path);
  if (is_there(path)) {
    result.sidecar = read_sidecar(path);
    result.sidecar_matches = result.sidecar->file.bytes == file.bytes().size() &&
                             result.sidecar->file.head_checksum == file.grid().head_checksum();
  }
  result.histogram = result.sidecar && result.sidecar_matches ? result.sidecar->histogram
                                                              : counted_histogram(file.grid(), arguments.progress);
  return result;
}

void print_grid(const NvdbFile& file) {
  const NvdbGrid& g = file.grid();
  const Box box = g.index_bbox();
  const auto line = [](const char* key, const std::string& value) { std::cout << cat(key, value, '\n'); };
  line("file        ", file.path());
  line("size        ", cat(file.bytes().size(), " bytes (", format_bytes(file.bytes().size()), "), grid at ",
                           g.grid_offset(), ", ", g.grid_bytes() - g.data_bytes(), " bytes of padding"));
  line("format      ", cat("NanoVDB ", nvdb_version_text(g.version()), ", head checksum ", hex(g.head_checksum(), 8),
                           ' ', checksum_state(g)));
  line("grid        ",
       cat('"', printable(g.name()), "\" ", grid_type_name(g.type()), g.packed() != nullptr ? " packed, " : ", ",
           shown_text(box.extent()), " voxels from (", box.lo.x, ", ", box.lo.y, ", ", box.lo.z, ")"));
  line("transform   ", cat("voxel size ", shown_text(g.voxel_size()), ", origin ", shown_text(g.world_origin())));
  const std::string range = g.value_min() <= g.value_max() ? cat(g.value_min(), " .. ", g.value_max()) : "none finite";
  line("values      ", cat(range, ", background ", g.background()));
  const auto nodes = g.node_counts();
  const auto tiles = g.tile_counts();
  line("tree        ", cat(g.root_tiles(), " root entries, ", nodes[2], " upper, ", nodes[1], " lower, ", nodes[0],
                           " leaves; ", g.active_voxels(), " active voxels"));
  line("tiles       ", cat(tiles[0], " of 8^3, ", tiles[1], " of 128^3, ", tiles[2], " of 4096^3 active"));
  const MacrocellView cells = g.macrocells();
  line("macrocells  ", cells.cells.empty() ? "none"
                                           : cat(shown_text(cells.lattice.count), " of ", cells.cell,
                                                 "^3 voxels, apron ", cells.apron));
}

constexpr std::array kKinds{PackedKind::mean, PackedKind::transform, PackedKind::lattice, PackedKind::raw};

void print_packed(const PackedData& packed, const PackedCensus& census) {
  std::string kinds;
  for (const PackedKind kind : kKinds) {
    const std::uint64_t blocks = census.blocks[static_cast<std::size_t>(kind)];
    kinds += cat(blocks, ' ', packed_kind_name(kind));
    if (blocks != 0) kinds += cat(" (", two_decimals(census.bits_a_voxel(kind)), " bits a voxel)");
    kinds += ", ";
  }
  std::cout << cat("packed      ", packed_block_count(packed), " blocks of 8^3: ", kinds, census.none, " none; ",
                   format_bytes(packed.bytes().size()), ", of which directories and tables ",
                   format_bytes(census.directory_bytes), '\n');
  std::cout << (packed.header().preview
                    ? "            Other readers of NanoVDB files see the mean of each block of 8^3.\n"
                    : "            Other readers of NanoVDB files see next to nothing: the file has no preview.\n");
}

Json packed_json(const PackedData& packed, const PackedCensus& census) {
  Json blocks;
  Json bits;
  for (const PackedKind kind : kKinds) {
    blocks[packed_kind_name(kind)] = census.blocks[static_cast<std::size_t>(kind)];
    bits[packed_kind_name(kind)] = census.bits_a_voxel(kind);
  }
  blocks["none"] = census.none;
  return {{"bytes", packed.bytes().size()},
          {"directory_bytes", census.directory_bytes},
          {"preview", packed.header().preview},
          {"blocks", blocks},
          {"bits_a_voxel", bits}};
}

std::string certificate_text(const Sidecar::CertifiedError& error) {
  if (error.lossless) return "lossless: every voxel as in the source";
  return cat("PSNR ", error.psnr_db ? cat(*error.psnr_db) : std::string("none"), " dB, RMSE ", error.rmse, ", NMSE ",
             error.nmse, ", largest ", error.max_abs);
}

void print_sidecar(const Sidecar& s) {
  const auto line = [](const char* key, const std::string& value) { std::cout << cat(key, value, '\n'); };
  line("source      ",
       cat(s.source.path, s.source.dataset.empty() ? "" : ":", s.source.dataset, ", ", s.source.format, ' ',
           s.source.type, ", ", shown_text(s.source.extent), ", range ", s.value_range[0], " .. ", s.value_range[1]));
  line("budget      ", cat(s.budget.kind, s.budget.requested ? cat(' ', *s.budget.requested) : std::string(), ": ",
                           s.budget.file_bytes, " of ", s.budget.dense_float32_bytes, " bytes, rate ", s.budget.rate));
  const auto& bits = s.selection.bits;
  line("selection   ", cat(s.selection.leaves_kept, " of ", s.selection.leaves_total, " leaves by ", s.selection.metric,
                           ", brick ", s.selection.brick, ", fill ", s.selection.fill, "; bits 1:", bits[0],
                           " 2:", bits[1], " 4:", bits[2], " 8:", bits[3], " 16:", bits[4], " 32:", bits[5]));
  line("background  ",
       cat(s.background.value, ", ", s.background.method, ", ", 100 * s.background.share, " % of the voxels"));
  line("error       ", certificate_text(s.error));
  if (s.visible) {
    line("visible     ", cat(s.visible->voxels, " voxels in ", s.visible->blocks, " blocks, by ", s.visible->scene,
                             ": ", certificate_text(s.visible->error)));
  }
  line("cost        ", cat(s.timing.total_s, " s, peak memory ", format_bytes(s.timing.peak_rss_bytes)));
}

void print_text(const NvdbFile& file, const Inspection& found) {
  print_grid(file);
  if (found.packed) print_packed(*file.grid().packed(), *found.packed);
  if (!found.sidecar) {
    std::cout << "sidecar     none\n";
  } else if (!found.sidecar_matches) {
    std::cout << "sidecar     belongs to another volume (size or head checksum differ)\n";
  } else {
    print_sidecar(*found.sidecar);
  }
  std::cout << '\n' << histogram_text(found.histogram);
}

void print_json(const NvdbFile& file, const Inspection& found) {
  const NvdbGrid& g = file.grid();
  const MacrocellView cells = g.macrocells();
  Json report{
      {"path", file.path()},
      {"file",
       {{"bytes", file.bytes().size()},
        {"grid_offset", g.grid_offset()},
        {"grid_bytes", g.grid_bytes()},
        {"data_bytes", g.data_bytes()},
        {"version", nvdb_version_text(g.version())},
        {"head_checksum", hex(g.head_checksum(), 8)},
        {"head_checksum_state", checksum_state(g)}}},
      {"grid",
       {{"name", g.name()},
        {"type", grid_type_name(g.type())},
        {"index_bbox", {json_of(g.index_bbox().lo), json_of(g.index_bbox().hi)}},
        {"voxel_size", g.voxel_size()},
        {"origin", g.world_origin()},
        {"background", g.background()},
        {"value_range", {g.value_min(), g.value_max()}}}},
      {"tree",
       {{"root_entries", g.root_tiles()},
        {"upper", g.node_counts()[2]},
        {"lower", g.node_counts()[1]},
        {"leaves", g.node_counts()[0]},
        {"active_tiles", {{"8", g.tile_counts()[0]}, {"128", g.tile_counts()[1]}, {"4096", g.tile_counts()[2]}}},
        {"active_voxels", g.active_voxels()}}},
      {"packed", found.packed ? packed_json(*g.packed(), *found.packed) : Json()},
      {"macrocells", cells.cells.empty()
                         ? Json()
                         : Json{{"cell", cells.cell}, {"dims", json_of(cells.lattice.count)}, {"apron", cells.apron}}},
      {"histogram", {{"min", found.histogram.min}, {"max", found.histogram.max}, {"counts", found.histogram.counts}}},
      {"sidecar_matches", found.sidecar ? Json(found.sidecar_matches) : Json()},
      {"sidecar", found.sidecar ? Json::parse(to_json_text(*found.sidecar)) : Json()}};
  std::cout << report.dump(-1, ' ', false, Json::error_handler_t::replace) << '\n';
}

void run(const InspectArguments& arguments) {
  // A damaged .nvdb without its magic is still no raw file.
  if (!arguments.path.ends_with(".nvdb") && format_of(arguments.path).name != "nvdb") {
    if (!arguments.plot.empty()) {
      throw Error(ErrorKind::usage,
                  cat("--plot is for .nvdb files, and ", arguments.path, " is none; convert it first"));
    }
    print_listing(list_input(arguments.path, read_conversion_request(arguments.source).source), arguments.json);
    return;
  }
  const auto files = make_posix_file_system();
  std::optional<PlotFormat> format;
  std::optional<PartialFile> chart;
  if (!arguments.plot.empty()) {
    format = plot_format(arguments.plot);
    load_driver("plot", arguments.plot + ": is to be a chart");
    chart.emplace(*files, arguments.plot, true);
  }
  const NvdbFile file(arguments.path);
  const auto threads = limit_threads(0);
  const Inspection found = look_at(file, arguments);
  if (chart) {
    const std::string bytes = histogram_chart(found.histogram, file.grid().background(), *format);
    chart->file().write_at(0, std::as_bytes(std::span(bytes)));
    chart->commit();
  }
  if (arguments.json) {
    print_json(file, found);
  } else {
    print_text(file, found);
  }
}

}  // namespace

void add_inspect(CLI::App& app) {
  auto arguments = std::make_shared<InspectArguments>();
  CLI::App* command = app.add_subcommand("inspect",
                                         "Shows header, tree, budget, certificate and histogram of a .nvdb file, or "
                                         "lists what an input holds and the command to convert it");
  command->add_option("volume", arguments->path, "a .nvdb file, weir's or another's, or an input")
      ->type_name("FILE")
      ->required();
  command->add_option("--plot", arguments->plot, "also draws the histogram, as FILE.png or FILE.svg")
      ->type_name("FILE");
  command->add_flag("--json", arguments->json, "one JSON object on stdout");
  add_input_options(*command, arguments->source);
  add_progress_options(*command, arguments->progress);
  add_log_level(*command);
  command->callback([arguments] { run(*arguments); });
}

}  // namespace weir
