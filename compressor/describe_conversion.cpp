#include "compressor/describe_conversion.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <limits>
#include <utility>

#include "compressor/conversion_identity.h"
#include "compressor/leaf/certificate.h"
#include "format/base/utf8.h"
#include "format/io/real_path.h"
#include "format/layout/nvdb_type.h"
#include "format/nanovdb/macrocells.h"

namespace weir {
namespace {

// Returns the value range; NaN, which is null in the document, if no value is finite.
std::array<double, 2> range_of(const Survey& survey) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  if (survey.finite == 0) return {kNone, kNone};
  return {static_cast<double>(survey.min), static_cast<double>(survey.max)};
}

Sidecar::Histogram histogram_of(const Survey& survey) {
  const RangeHistogram& h = survey.histogram;
  if (h.empty()) return {};
  auto counts = h.counts();
  const double max = h.first_edge() + static_cast<double>(counts.size()) * h.bin_width();
  return {h.first_edge(), max, std::move(counts)};
}

Sidecar::CertifiedError describe_error(const DecodedErrors& tiles, const DecodedErrors& leaves, std::uint64_t finite,
                                       const Survey& survey) {
  DecodedErrors all = tiles;
  all.squared += leaves.squared;
  all.add_but_squares(leaves);
  const Certificate c =
      make_certificate(all.squared, all.max_abs, all.kept != Kept::lossy, finite, survey.min, survey.max);
  return {c.mse, c.rmse, c.nmse, c.psnr_db, c.max_abs, c.lossless};
}

void describe_details(const FieldDetails& details, Sidecar::Source& source) {
  source.long_name = details.long_name;
  source.component = details.component;
  source.orientation = details.orientation;
  source.unstored_chunks = details.chunks_note;
  if (details.level) source.level = Sidecar::Level{details.level->number, details.level->count};
  if (details.time) source.time = Sidecar::Time{details.time->value, details.time->units, details.time->calendar};
  for (std::size_t i = 0; i < details.axes.size(); ++i) {
    source.axis_units.at(i) = details.axes.at(i).units;
    if (details.axes.at(i).reversed) source.reversed_axes.emplace_back(1, "xyz"[i]);
  }
  const auto& [x, y, z] = details.axes;
  if (x.coordinates.empty() && y.coordinates.empty() && z.coordinates.empty()) return;
  source.irregular_axes = {x.coordinates, y.coordinates, z.coordinates};
}

}  // namespace

std::string real_path_of(const SourceInfo& info) {
  if (info.files.empty()) return {};  // a pushed volume: info.path is only its name
  return absolute_real_path(is_there(info.path) ? info.path : info.files.front().path);
}

std::string grid_name(const std::string& dataset) {
  const auto serves = [](const std::string& name) {
    return !name.empty() && name.size() <= kMaxGridNameBytes && is_utf8(name);
  };
  if (serves(dataset)) return dataset;
  const std::string last = dataset.substr(dataset.rfind('/') + 1);
  return serves(last) ? last : "density";
}

Sidecar describe_source(const SourceInfo& info, const Survey& survey, const ConversionOptions& options) {
  Sidecar sidecar;
  sidecar.source.path = info.path;
  // In two working directories, a relative path may name two different files.
  if (std::filesystem::path(info.path).is_relative()) sidecar.source.real_path = real_path_of(info);
  sidecar.source.format = info.format;
  sidecar.source.dataset = info.dataset;
  sidecar.source.extent = info.extent;
  sidecar.source.type = std::string(scalar_name(info.type));
  sidecar.source.bytes = info.file_bytes;
  sidecar.source.mtime = utc_text(info.mtime_ns);
  sidecar.value_range = range_of(survey);
  sidecar.nonfinite = {survey.non_finite, policy_name(options.non_finite)};
  sidecar.source.index = info.index;
  sidecar.source.axes = info.axis_labels;
  sidecar.source.units = info.units;
  sidecar.source.unit_si = info.unit_si;
  sidecar.source.scale = info.mapping.scale;
  sidecar.source.offset = info.mapping.offset;
  describe_details(info.details, sidecar.source);
  sidecar.source.files_digest = info.files_digest;
  sidecar.source.values = options.source_values;
  sidecar.missing.count = info.mapping.keeps_missing ? survey.loss.unmarked : survey.missing;
  sidecar.missing.policy = info.mapping.keeps_missing ? "keep" : missing_policy_name(options);
  for (const StoredValue& value : info.mapping.missing) sidecar.missing.values.push_back(stored_value_text(value));
  sidecar.conversion_loss = {survey.loss.inexact, survey.loss.overflow, survey.loss.max_abs_error};
  sidecar.histogram = histogram_of(survey);
  sidecar.weir = options.provenance;
  return sidecar;
}

void describe_file(Sidecar& sidecar, const SourceInfo& info, const Survey& survey, const ConversionOptions& options,
                   const Background& background, const GridHead& head, const EncodedFile& encoded, const Shown& shown) {
  const FilePlan& file = encoded.file;
  const FileSize& size = file.size;
  const std::uint64_t dense_bytes = float32_bytes(info.domain());
  sidecar.grid = {head.name, grid_type_name(head.type), info.extent, info.spacing, info.origin, info.domain()};
  sidecar.background = {static_cast<double>(background.value), background.method, background.share};
  sidecar.budget.kind = size.kind;
  if (size.kind == "rate") sidecar.budget.requested = options.budget.rate;
  if (options.budget.by_error()) sidecar.budget.requested = options.budget.target;
  if (options.budget.kind == Budget::Kind::automatic && size.kind == "psnr") {
    sidecar.budget.requested = kDefaultLeastDb;
  }
  if (size.kind == "size") sidecar.budget.requested = static_cast<double>(options.budget.bytes);
  sidecar.budget.file_bytes = size.bytes;
  sidecar.budget.dense_float32_bytes = dense_bytes;
  sidecar.budget.rate = static_cast<double>(dense_bytes) / static_cast<double>(size.bytes);
  sidecar.zeros = {file.plan.zeros, file.plan.tiles.zeros_lost + encoded.errors.zeros_lost};
  sidecar.selection = {metric_name(options.metric),
                       fill_name(options.fill),
                       options.brick,
                       static_cast<std::uint64_t>(file.tree->leaves.size()),
                       file.plan.kept,
                       file.plan.leaves_by_width,
                       {}};
  sidecar.error = describe_error(file.plan.tiles, encoded.errors, survey.finite, survey);
  if (options.scene) {
    sidecar.visible = {options.scene->path, shown.blocks, shown.finite,
                       describe_error(file.plan.seen_tiles, encoded.seen_errors, shown.finite, survey),
                       scene_digest(options.scene->scene)};
  }
  if (file.packed) {
    const auto& blocks = file.plan.blocks;
    sidecar.packed = Sidecar::Packed{file.packed->preview};
    sidecar.selection.blocks = {sidecar.selection.leaves_total - file.plan.kept, blocks[0], blocks[1], blocks[2],
                                blocks[3]};
    sidecar.error_preview = describe_error(file.plan.preview, {}, survey.finite, survey);
  }
  sidecar.macrocells = {kMacrocell, make_lattice(info.domain(), kMacrocell).count, kMacrocellApron};
}

}  // namespace weir
