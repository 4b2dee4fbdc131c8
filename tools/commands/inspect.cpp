// weir inspect: shows what a NanoVDB file holds and what its sidecar says, or what an input holds. Decodes no block
// unless the histogram has to be counted (no sidecar); for a packed file it reads all directories.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "format/base/error.h"
#include "format/base/json_text.h"
#include "format/base/printable.h"
#include "format/base/text.h"
#include "format/io/file_id.h"
#include "format/io/file_system.h"
#include "format/io/real_path.h"
#include "format/layout/nanovdb_layout.h"
#include "format/nanovdb/nvdb_checksum.h"
#include "format/nanovdb/nvdb_file.h"
#include "format/nanovdb/nvdb_header.h"
#include "format/output/partial_file.h"
#include "format/sidecar/find_sidecar.h"
#include "format/sidecar/is_of.h"
#include "format/sidecar/read_sidecar.h"
#include "format/sidecar/valid_voxels.h"
#include "gpu/image/image_output.h"
#include "gpu/volume/macrocell_grid.h"
#include "ingest/drivers/driver.h"
#include "tools/command.h"
#include "tools/command_request.h"
#include "tools/options/finite_range.h"
#include "tools/options/run_options.h"
#include "tools/options/table_options.h"
#include "tools/options/volume_series.h"
#include "tools/report/error_line.h"
#include "tools/report/error_text.h"
#include "tools/report/histogram_plot.h"
#include "tools/report/input_listing.h"
#include "tools/report/map_warning.h"
#include "tools/report/progress.h"
#include "tools/report/quantity_title.h"
#include "tools/report/volume_title.h"
#include "tools/verify/packed_census.h"
#include "tools/verify/packed_report.h"
#include "tools/verify/tree_census.h"

namespace weir {
namespace {

using Json = nlohmann::ordered_json;

/// Options that choose a part or a component of a volume; the listing shows all.
constexpr std::array<std::string_view, 5> kNotListed{"index", "component", "magnitude", "roi", "ghost"};

constexpr std::size_t kBins = 256;  // bins of a histogram that is counted here

struct InspectArguments {
  std::vector<std::string> paths;
  GivenOptions source;
  std::string plot;
  bool json = false;
  ProgressOptions progress;
};

struct Inspection {
  const NvdbGrid& grid;
  std::optional<Sidecar> sidecar;
  bool sidecar_matches = false;          ///< size, head checksum and digest match the volume's (is_of.h)
  std::optional<Error> sidecar_error{};  ///< why an existing sidecar cannot be read; nullopt: readable or missing
  Sidecar::Histogram histogram;
  std::optional<PackedCensus> packed;  ///< only for a packed grid
  MinMax values{};                     ///< least and largest value; NaN if none is finite
};

std::string shown_text(const Index3& i) { return cat(i.x, " x ", i.y, " x ", i.z); }
std::string shown_text(const std::array<double, 3>& v) { return cat(v[0], ", ", v[1], ", ", v[2]); }
// Returns the range with enough digits to tell its ends apart.
std::string range_text(const std::array<double, 2>& range) {
  if (std::isnan(range[0]) && std::isnan(range[1])) return "none finite";
  const std::string low = short_number(range[0]);
  const std::string high = short_number(range[1]);
  if (low != high || range[0] == range[1]) return cat(low, " .. ", high);
  return cat(range[0], " .. ", range[1]);
}
Json json_of(const Index3& i) { return {i.x, i.y, i.z}; }

const char* checksum_state(const NvdbGrid& grid) {
  if (grid.head_checksum() == static_cast<std::uint32_t>(nvdb::kNoChecksum)) return "absent";
  return grid.head_checksum() == computed_head_checksum(grid) ? "ok" : "wrong";
}

// Returns the range in the root, or if its writer left that out, the range of all blocks.
MinMax range_of_values(const NvdbGrid& grid) {
  const MinMax stored{grid.value_min(), grid.value_max()};
  if (!std::isnan(stored.min) || !std::isnan(stored.max)) return stored;
  return MacrocellGrid(grid, kMacrocell).finite_range().value_or(stored);
}

Sidecar::Histogram counted_histogram(const NvdbGrid& grid, const MinMax& range, const ProgressOptions& shown) {
  Progress progress(shown);
  progress.start("histogram", grid.data_bytes());
  const auto leaf_bytes = grid.data_bytes() / std::max<std::uint64_t>(census_blocks(grid), 1);
  return finite_histogram(grid, range, kBins, [&](std::uint64_t leaves) {
    progress.update(leaves * leaf_bytes);
    if (interrupt_flag()) throw Error(ErrorKind::interrupted, "interrupted");
  });
}

Inspection look_at(const NvdbFile& file, const ProgressOptions& progress) {
  Inspection result{file.grid(), std::nullopt, false, std::nullopt, {}, std::nullopt, {}};
  if (const PackedData* packed = file.grid().packed()) result.packed = take_packed_census(*packed);
  const std::string path = find_sidecar(file.path());
  if (is_there(path)) {
    try {
      result.sidecar = read_sidecar(path);
      result.sidecar_matches = is_of(*result.sidecar, file);
    } catch (const Error& error) {  // the volume may still be sound
      result.sidecar_error = error;
    }
  }
  result.values = range_of_values(file.grid());
  result.histogram = result.sidecar && result.sidecar_matches ? result.sidecar->histogram
                                                              : counted_histogram(file.grid(), result.values, progress);
  return result;
}

HistogramLabels labels_of(const NvdbFile& file, const Inspection& found) {
  const bool recorded = found.sidecar && found.sidecar_matches;
  const std::string title =
      recorded ? volume_title(found.sidecar->source) : std::filesystem::path(file.path()).filename().string();
  const std::string values = quantity_title(file);
  return {printable(title), values.empty() ? "value" : printable(values)};
}

// Prints a line. Names and units come from a foreign file, so control characters are escaped.
void line(const char* key, const std::string& value) { std::cout << cat(key, one_line(value), '\n'); }

void print_grid(const NvdbFile& file, const MinMax& values) {
  const NvdbGrid& g = file.grid();
  const Box box = g.index_bbox();
  line("file        ", file.path());
  line("size        ", cat(file.bytes().size(), " bytes (", format_bytes(file.bytes().size()), "), grid at ",
                           g.grid_offset(), ", ", g.grid_bytes() - g.data_bytes(), " bytes of padding"));
  line("format      ", cat("NanoVDB ", nvdb_version_text(g.version()), ", head checksum ", hex(g.head_checksum(), 8),
                           ' ', checksum_state(g)));
  line("grid        ", cat('"', g.name(), "\" ", grid_type_name(g.type()), g.packed() != nullptr ? " packed, " : ", ",
                           shown_text(box.extent()), " voxels from (", box.lo.x, ", ", box.lo.y, ", ", box.lo.z, ")"));
  line("transform   ", cat("voxel size ", shown_text(g.voxel_size()), ", origin ", shown_text(g.world_origin())));
  if (const std::string turned = map_warning(g); !turned.empty()) line("            ", turned);
  const std::string range = values.min <= values.max ? range_text({values.min, values.max}) : "none finite";
  line("values      ", cat(range, ", background ", short_number(static_cast<double>(g.background()))));
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

std::string certificate_text(const Sidecar& s, const Sidecar::CertifiedError& error) {
  if (error.lossless) {
    // Rounding is mentioned only if it is visible: float32 rounds every value to some digit.
    const double seen = 1e-4 * (s.value_range[1] - s.value_range[0]);
    const bool rounded = s.conversion_loss.overflow > 0 || s.conversion_loss.max_abs_error > seen;
    return cat(lossless_text(s), lossless_everywhere(s) ? ": every voxel" : ": each of them", " as in the source",
               rounded ? " rounded to float32" : "");
  }
  return cat(error_text(s, error), ", RMSE ", short_number(error.rmse), ", NMSE ", short_number(error.nmse));
}

std::string in_brackets(const std::string& units) { return units.empty() ? "" : cat(" (", units, ')'); }

void print_sidecar(const Sidecar& s) {
  line("source      ",
       cat(s.source.path, s.source.dataset.empty() ? "" : ":", s.source.dataset, ", ", s.source.format, ' ',
           s.source.type, ", ", shown_text(s.source.extent), ", range ", range_text(s.value_range)));
  if (!s.source.long_name.empty()) line("quantity    ", cat(s.source.long_name, in_brackets(s.source.units)));
  if (!s.source.component.empty()) line("component   ", s.source.component);
  if (s.source.time) line("time        ", cat(s.source.time->value, ' ', s.source.time->units));
  line("budget      ",
       cat(s.budget.kind, s.budget.requested ? cat(' ', *s.budget.requested) : std::string(), ": ", s.budget.file_bytes,
           " of ", s.budget.dense_float32_bytes, " bytes, rate ", short_number(s.budget.rate)));
  const auto& bits = s.selection.bits;
  line("selection   ", cat(s.selection.leaves_kept, " of ", s.selection.leaves_total, " leaves by ", s.selection.metric,
                           ", brick ", s.selection.brick, ", fill ", s.selection.fill, "; bits 1:", bits[0],
                           " 2:", bits[1], " 4:", bits[2], " 8:", bits[3], " 16:", bits[4], " 32:", bits[5]));
  const double share = s.background.share;  // 0 if the background was given and not counted
  line("background  ", cat(short_number(static_cast<double>(s.background.value)), ", ", s.background.method,
                           share > 0 ? cat(", ", short_number(100 * share), " % of the voxels") : std::string()));
  if (const std::string text = rounded_text(s.conversion_loss); !text.empty()) line("rounded     ", text);
  if (const std::string text = missing_text(s); !text.empty()) line("missing     ", text);
  if (const std::string text = nonfinite_text(s); !text.empty()) line("not finite  ", text);
  line("error       ", certificate_text(s, s.error));
  if (s.gradient) line("gradient    ", gradient_text(*s.gradient, s.source.units));
  const Sidecar::Zeros zeros = s.zeros.value_or(Sidecar::Zeros{});
  if (zeros.lost > 0) line("zeros       ", lost_zeros_text(zeros.lost, zeros.count));
  if (s.visible && s.visible->blocks == 0) {
    line("visible     ", cat("nothing, by ", s.visible->scene));
  } else if (s.visible) {
    line("visible     ", cat(s.visible->voxels, " voxels in ", s.visible->blocks, " blocks, by ", s.visible->scene,
                             ": ", certificate_text(s, s.visible->error)));
  }
  line("cost        ", cat(short_number(s.timing.total_s), " s, peak memory ", format_bytes(s.timing.peak_rss_bytes)));
}

void print_text(const NvdbFile& file, const Inspection& found) {
  print_grid(file, found.values);
  if (found.packed) std::cout << packed_text(*file.grid().packed(), *found.packed);
  if (found.sidecar_error) {
    line("sidecar     ", cat("unreadable: ", found.sidecar_error->what()));
  } else if (!found.sidecar) {
    std::cout << "sidecar     none\n";
  } else if (!found.sidecar_matches) {
    std::cout << "sidecar     belongs to another volume (size, head checksum or digest differ)\n";
  } else {
    print_sidecar(*found.sidecar);
  }
  std::cout << '\n' << histogram_text(found.histogram);
}

Json to_json(const NvdbFile& file, const Inspection& found) {
  const NvdbGrid& g = file.grid();
  const MacrocellView cells = g.macrocells();
  return {
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
        {"value_range", {found.values.min, found.values.max}}}},
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
      {"sidecar_error", found.sidecar_error ? Json(found.sidecar_error->what()) : Json()},
      {"sidecar", found.sidecar ? Json::parse(to_json_text(*found.sidecar)) : Json()}};
}

/// The result for one file.
struct Inspected {
  Json report{};                   ///< with --json
  std::optional<Error> problem{};  ///< a fault besides a volume that could be read; nullopt: none
};

// Returns whether `path` is taken as a grid. A damaged .nvdb without its magic is still no raw file.
bool is_grid(const std::string& path, const SourceOptions& options) {
  return !options.stack && (path.ends_with(".nvdb") || is_nanovdb(path));
}

/// Prints the result, after an empty line if `apart`, or returns it as JSON. `options` are those of arguments.source.
Inspected inspect(const std::string& path, const InspectArguments& arguments, const SourceOptions& options,
                  bool apart) {
  if (!is_grid(path, options)) {
    if (!arguments.plot.empty()) {
      throw Error(ErrorKind::usage, cat("--plot is for .nvdb files, and ", path, " is none; convert it first"));
    }
    InputListing listing = list_input(path, options);
    if (!options.dataset.empty() && !options.stack) keep_named(listing, options.dataset);
    GivenOptions besides = arguments.source;
    if (!options.stack) besides.erase("dataset");  // each command names its own dataset
    listing.words = input_words(besides);
    if (arguments.json) return {to_json(listing)};
    if (apart) std::cout << '\n';
    print_text(listing);
    return {};
  }
  if (const std::string key = given_input_option(arguments.source); !key.empty()) {
    throw Error(ErrorKind::usage,
                compose(option(key), " says how to read a source, and ", path, " is a .nvdb file; leave it out"));
  }
  const auto files = make_posix_file_system();
  std::optional<PlotFormat> format;
  std::optional<PartialFile> chart;
  if (!arguments.plot.empty()) {
    format = plot_format(arguments.plot, "plot");
    require_not_input(file_ids(std::array{path, find_sidecar(path)}), arguments.plot);
    load_driver("plot", arguments.plot + ": is to be a chart");
    chart.emplace(*files, arguments.plot, true);
  }
  const NvdbFile file(path);
  const auto threads = limit_threads(0);
  const Inspection found = look_at(file, arguments.progress);
  if (chart) {
    const std::string bytes =
        histogram_chart(found.histogram, file.grid().background(), labels_of(file, found), *format);
    chart->file().write_at(0, std::as_bytes(std::span(bytes)));
    chart->commit();
  }
  if (arguments.json) return {to_json(file, found), found.sidecar_error};
  if (apart) std::cout << '\n';
  print_text(file, found);
  return {{}, found.sidecar_error};
}

void run(const InspectArguments& arguments) {
  const SourceOptions options = command_request(arguments.source).source;
  const std::vector<std::string> paths = options.stack ? arguments.paths : expand_volumes(arguments.paths);
  if (paths.size() > 1 && !arguments.plot.empty()) {
    throw usage_error(cat("--plot draws one histogram, and ", paths.size(), " files are given; give one of them"));
  }
  const bool several = paths.size() > 1;
  Json reports = Json::array();
  bool printed = false;
  int status = 0;
  const auto say = [&](const Error& problem) {
    std::cout.flush();
    print_error_line(problem.what());
    if (status == 0) status = problem.exit_code();
  };
  for (const std::string& path : paths) {
    try {
      Inspected found = inspect(path, arguments, options, printed);
      printed = true;
      reports.push_back(std::move(found.report));
      if (found.problem) say(*found.problem);
    } catch (const Error& error) {
      const bool of_file = error.kind() == ErrorKind::input || error.kind() == ErrorKind::io;
      if (!several || !of_file) throw;
      say(error);
      reports.push_back({{"path", path}, {"error", error.what()}});
    }
  }
  if (arguments.json) {
    const Json report = several ? Json{{"files", reports}} : reports.front();
    std::cout << json_text(report) << '\n';
  }
  if (status != 0) throw ExitStatus{status};
}

}  // namespace

void add_inspect(CLI::App& app) {
  auto arguments = std::make_shared<InspectArguments>();
  CLI::App* command = app.add_subcommand("inspect",
                                         "Shows header, tree, budget, certificate and histogram of a .nvdb file, or "
                                         "lists what an input holds and the command to convert it");
  command
      ->add_option("volume", arguments->paths,
                   "a .nvdb file, weir's or another's, or an input; or several, or patterns in quotes, 'out/*.nvdb' or "
                   "'step_%04d.nvdb'")
      ->type_name("FILE")
      ->required();
  command
      ->add_option("--plot", arguments->plot,
                   "also draws the histogram, as FILE.png or FILE.svg, which replaces one that is there")
      ->type_name("FILE");
  command->add_flag("--json", arguments->json, "one JSON object on stdout");
  add_input_options_of_one(*command, arguments->source, kNotListed);
  add_progress_options(*command, arguments->progress);
  add_log_level(*command);
  command->callback([arguments] { run(*arguments); });
}

}  // namespace weir
