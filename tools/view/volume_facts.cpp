#include "tools/view/volume_facts.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "format/base/error.h"
#include "format/base/text.h"
#include "format/layout/nvdb_type.h"
#include "format/sidecar/read_sidecar.h"
#include "gpu/image/colormap.h"
#include "gpu/scene/scene_transfer.h"
#include "ingest/source/convert_command.h"
#include "tools/options/finite_range.h"
#include "tools/report/error_text.h"
#include "tools/report/quantity_title.h"
#include "tools/report/volume_title.h"
#include "tools/verify/packed_census.h"
#include "tools/verify/tree_census.h"

namespace weir {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kOpacities = 33;  // points of the default opacity curve

Json index_json(const Index3& i) { return {i.x, i.y, i.z}; }

// Returns "inf" and "-inf" as texts, because JSON has no infinity.
Json end_json(float value) {
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  return value;
}

// Returns the kinds of blocks that occur, with their numbers: [["transform", 1234], ...].
Json kinds_of(const NvdbGrid& grid, const std::optional<Sidecar>& sidecar) {
  Json kinds = Json::array();
  const auto add = [&](const std::string& name, std::uint64_t blocks) {
    if (blocks > 0) kinds.push_back({name, blocks});
  };
  if (grid.packed() != nullptr) {
    const PackedCensus census = take_packed_census(*grid.packed());
    for (const PackedKind kind : {PackedKind::transform, PackedKind::lattice, PackedKind::raw, PackedKind::mean}) {
      add(packed_kind_name(kind), census.blocks[static_cast<std::size_t>(kind)]);
    }
    add("constant", census.none);
  } else if (sidecar) {
    constexpr std::array kNames{"1 bit", "2 bits", "4 bits", "8 bits", "16 bits", "float32"};
    for (std::size_t i = 0; i < kNames.size(); ++i) add(kNames.at(i), sidecar->selection.bits.at(i));
    add("one value", sidecar->selection.leaves_total - sidecar->selection.leaves_kept);
  } else {
    add("leaves", grid.node_counts()[0]);
    add("tiles", grid.tile_counts()[0]);
  }
  return kinds;
}

Json certificate_of(const Sidecar& s) {
  return {{"source", volume_title(s.source)},
          {"units", s.source.units},
          {"time", s.source.time ? Json(cat(short_number(s.source.time->value), ' ', s.source.time->units)) : Json()},
          {"rate", s.budget.rate},
          {"dense_bytes", s.budget.dense_float32_bytes},
          {"lossless", s.error.lossless},
          {"psnr_db", s.error.psnr_db ? Json(*s.error.psnr_db) : Json()},
          {"rmse", s.error.rmse},
          {"max_abs", s.error.max_abs},
          {"text", error_text(s, s.error)}};
}

std::string hex_colour(const Float3& linear) {
  std::string text = "#";
  for (const float channel : {linear.x, linear.y, linear.z}) {
    text += hex(static_cast<std::uint64_t>(std::lround(srgb_from_linear(channel) * 255.0F)), 2);
  }
  return text;
}

}  // namespace

SeenValues seen_values(const SeriesSummary& series) {
  const MinMax range = series.range.value_or(MinMax{0, 1});
  return {range, series.background.value_or(range.min)};
}

SeenValues seen_values(const NvdbFile& file, const std::function<std::shared_ptr<const MacrocellGrid>()>& cells) {
  const NvdbGrid& grid = file.grid();
  SeriesSummary one;
  add_values(one, grid.background(), {grid.value_min(), grid.value_max()});
  if (!one.range) one.range = certified_range(file);
  if (!one.range) one.range = cells()->finite_range();
  return seen_values(one);
}

Json values_facts(const SeenValues& values) {
  const TransferFunction transfer = make_transfer_function({}, values.range, values.background, "gray");
  Json opacity = Json::array();
  for (std::size_t i = 0; i < kOpacities; ++i) {
    const std::size_t at = i * (transfer.table().size() - 1) / (kOpacities - 1);
    opacity.push_back(transfer.table()[at].a);
  }
  return {{"range", {values.range.min, values.range.max}}, {"background", values.background}, {"opacity", opacity}};
}

Json volume_facts(const NvdbFile& file, const std::string& name, const SeenValues& values) {
  const NvdbGrid& grid = file.grid();
  const std::optional<Sidecar> sidecar = own_sidecar(file);
  const Box box = grid.index_bbox();
  Json facts{{"file", name},
             {"word", shell_word(name.starts_with('-') ? "./" + name : name)},
             {"bytes", file.bytes().size()},
             {"title", quantity_title(file)},
             {"grid_type", grid.packed() != nullptr ? "packed" : grid_type_name(grid.type())},
             {"box", {index_json(box.lo), index_json(box.hi)}},
             {"voxel_size", grid.voxel_size()},
             {"origin", grid.world_origin()},
             {"values", {end_json(grid.value_min()), end_json(grid.value_max())}},
             {"kinds", kinds_of(grid, sidecar)},
             {"certificate", sidecar ? certificate_of(*sidecar) : Json()}};
  facts.update(values_facts(values));
  return facts;
}

Json histogram_facts(const NvdbFile& file, const std::atomic<bool>& cancel) {
  const NvdbGrid& grid = file.grid();
  Sidecar::Histogram histogram;
  if (const auto sidecar = own_sidecar(file)) {
    histogram = sidecar->histogram;
  } else {
    histogram = finite_histogram(grid, {grid.value_min(), grid.value_max()}, kViewBins, [&](std::uint64_t) {
      if (cancel) throw Error(ErrorKind::interrupted, "interrupted");
    });
  }
  // Neighbouring bins are merged until there are few enough.
  std::vector<std::uint64_t>& counts = histogram.counts;
  while (counts.size() > kViewBins && counts.size() % 2 == 0) {
    for (std::size_t i = 0; i < counts.size() / 2; ++i) counts[i] = counts[2 * i] + counts[2 * i + 1];
    counts.resize(counts.size() / 2);
  }
  return {{"min", histogram.min}, {"max", histogram.max}, {"counts", counts}};
}

Json colormap_facts() {
  Json maps;
  for (const std::string_view name : colormap_names()) {
    Json colours = Json::array();
    for (const Float3& colour : colormap(name, kMapColours)) colours.push_back(hex_colour(colour));
    maps[std::string(name)] = colours;
  }
  return maps;
}

}  // namespace weir
