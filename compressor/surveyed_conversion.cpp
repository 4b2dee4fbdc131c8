#include "compressor/surveyed_conversion.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <cmath>
#include <thread>
#include <vector>

#include "compressor/conversion_control.h"
#include "compressor/conversion_identity.h"
#include "compressor/encode/encode_attempts.h"
#include "compressor/encode/tree_writer.h"
#include "compressor/leaf/certificate.h"
#include "compressor/select/leaf_reach.h"
#include "compressor/survey/background.h"
#include "format/base/error.h"
#include "format/base/process_memory.h"
#include "format/base/seconds_since.h"
#include "format/base/text.h"
#include "format/io/digest.h"
#include "format/layout/nvdb_type.h"
#include "format/nanovdb/macrocells.h"
#include "ingest/files/file_state.h"

namespace weir {
namespace {

using Clock = std::chrono::steady_clock;

void refuse_non_finite(const Survey& survey, const SourceInfo& info) {
  if (survey.non_finite == 0) return;
  const Index3& at = survey.first_non_finite;
  const std::uint64_t beyond = std::min(survey.loss.overflow, survey.non_finite);
  const std::uint64_t others = survey.non_finite - beyond;
  std::string what;
  if (others > 0) what = cat(others, others == 1 ? " voxel is" : " voxels are", " NaN or infinite");
  if (beyond > 0) {
    what = cat(what, others > 0 ? " and " : "", beyond, beyond == 1 ? " voxel is" : " voxels are",
               " finite but beyond the 3.4e+38 of float32");
  }
  throw Error(ErrorKind::input, cat(info.path, ": ", what, ", the first (", survey.first_non_finite_value,
                                    beyond > 0 ? " as float32" : "", ") at ", at.x, ",", at.y, ",", at.z,
                                    beyond > 0 ? "; scale the values, or choose" : "; choose",
                                    " --nonfinite background or --nonfinite keep"));
}

Background choose_background(const ConversionOptions& options, const Survey& survey, const RowStore& rows,
                             VolumeSource& source, const BlockPlan& plan, const StreamOptions& stream) {
  if (options.background) return {*options.background, "user", 0};
  if (options.paper_background) return paper_background(survey, source, plan, stream, rows.team());
  return find_background(survey, rows, source, plan, stream);
}

// Reads the finished bytes back: what is hashed is what the file system holds.
Digest digest_of_file(File& file, std::uint64_t bytes, Team& team) {
  std::vector<Digest> pieces(piece_count(bytes));
  tbb::enumerable_thread_specific<std::vector<std::byte>> scratch{std::vector<std::byte>(kDigestScratchBytes)};
  const Share own = team.share(static_cast<std::int64_t>(pieces.size()));
  team.run([&] {
    tbb::parallel_for(static_cast<std::size_t>(own.begin), static_cast<std::size_t>(own.end), [&](std::size_t i) {
      const std::uint64_t offset = i * kDigestPieceBytes;
      pieces[i] = piece_digest(file, offset, std::min(kDigestPieceBytes, bytes - offset), scratch.local());
    });
  });
  team.gather(pieces);
  return combine(pieces);
}

std::array<double, 2> range_of(const Survey& survey) {
  return {static_cast<double>(survey.min), static_cast<double>(survey.max)};
}

Sidecar::Histogram histogram_of(const Survey& survey) {
  const RangeHistogram& h = survey.histogram;
  if (h.empty()) return {};
  auto counts = h.counts();
  const double max = h.first_edge() + static_cast<double>(counts.size()) * h.bin_width();
  return {h.first_edge(), max, std::move(counts)};
}

Sidecar describe_source(const SourceInfo& info, const Survey& survey, const ConversionOptions& options) {
  Sidecar sidecar;
  sidecar.source.path = info.path;
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
  sidecar.source.files_digest = info.files_digest;
  sidecar.missing.count = survey.missing;
  for (const StoredValue& value : info.mapping.missing) sidecar.missing.values.push_back(stored_value_text(value));
  sidecar.conversion_loss = {survey.loss.inexact, survey.loss.overflow, survey.loss.max_abs_error};
  sidecar.histogram = histogram_of(survey);
  sidecar.weir = options.provenance;
  return sidecar;
}

Sidecar::CertifiedError describe_error(const TileErrors& tiles, const LeafErrors& leaves, std::uint64_t finite,
                                       const Survey& survey) {
  const Certificate c = make_certificate(tiles.squared + leaves.squared, std::max(tiles.max_abs, leaves.max_abs),
                                         tiles.exact && leaves.exact, finite, survey.min, survey.max);
  return {c.mse, c.rmse, c.nmse, c.psnr_db, c.max_abs, c.lossless};
}

FileRequest request_for(const ConversionOptions& options, const Survey& survey, float background, const Box& domain) {
  FileRequest request;
  request.encoding = options.encoding;
  request.rule.metric = options.metric;
  request.rule.brick_leaves = options.brick / kLeafDim;
  request.rule.fill = {options.fill, background, options.non_finite};
  request.budget = options.budget;
  request.domain = domain;
  request.keeps_non_finite = options.non_finite == NonFinitePolicy::keep && survey.non_finite + survey.missing > 0;
  request.path = options.output;
  return request;
}

// What the squares over `finite` voxels may sum up to for a PSNR.
double allowed_error(const Budget& budget, const Survey& survey, std::uint64_t finite) {
  const double range = static_cast<double>(survey.max) - static_cast<double>(survey.min);
  return range * range * static_cast<double>(finite) / std::pow(10, budget.target / 10);
}

}  // namespace

std::optional<Visibility> visibility_of(const ConversionOptions& options, const Box& domain) {
  if (!options.scene) return std::nullopt;
  if (options.metric != Metric::sse) {
    throw Error(ErrorKind::usage, cat("--scene weighs squared errors, --metric ", metric_name(options.metric),
                                      " has none; use --metric sse"));
  }
  const bool promise = options.budget.by_error() || options.budget.kind == Budget::Kind::lossless;
  return Visibility(options.scene->scene, options.scene->path, domain,
                    promise ? Visibility::Weighing::alike : Visibility::Weighing::by_picture);
}

void check_source(const VolumeSource& source, Team& team) {
  team.run([&] { check_unchanged(source.info().files); });
}

bool surveys_widths(const ConversionOptions& options) {
  return options.encoding != Encoding::float32 && options.metric == Metric::sse;
}

Sidecar convert_surveyed(const ConversionJob& job, const ReadingPlan& reading, const Survey& survey,
                         SurveyStores& stores, Clock::time_point started) {
  VolumeSource& source = job.source;
  const ConversionOptions& options = job.options;
  const ConversionControl& control = job.control;
  OutputFiles& output = job.output;
  WorkDirectory& work = job.work;
  Journal* const journal = job.journal;
  const std::optional<Visibility>& visibility = job.seen;
  const SourceInfo& info = source.info();
  const Box domain = info.domain();
  const auto voxels = static_cast<std::uint64_t>(domain.voxels());
  const StreamOptions stream = stream_options(control);
  RowStore& rows = stores.rows;
  std::optional<TraceSpan> span;
  span.emplace(control.trace, "background");
  if (options.non_finite == NonFinitePolicy::error) refuse_non_finite(survey, info);
  Background background;
  Sidecar sidecar = describe_source(info, survey, options);
  Team& team = rows.team();
  const bool known = journal != nullptr && journal->state.background;
  const auto find = [&] {
    background =
        known ? *journal->state.background : choose_background(options, survey, rows, source, reading.survey, stream);
  };
  const auto digest = [&] { sidecar.source.digest = source_digest(rows); };
  if (team.alone()) {
    tbb::parallel_invoke(find, digest);
  } else {  // which meet in the same order everywhere
    find();
    team.lead(digest);
  }
  if (journal != nullptr) {
    journal->state.background = background;
    // Selection cannot be continued: let it not take the last blocks with it. A short conversion has none to lose.
    if (journal->resumable()) journal->save();
  }
  FileRequest request = request_for(options, survey, background.value, domain);
  Shown shown;
  if (visibility) {
    shown = find_reaches(*stores.faces, *visibility, request.rule.fill, work, rows);
    stores.faces.reset();
    request.rule.visibility = &*visibility;
  }
  request.squared_error = allowed_error(options.budget, survey, visibility ? shown.finite : survey.finite);
  sidecar.timing.survey_s = seconds_since(started);

  // Selection and encoding.
  span.reset();
  const auto check = [&] { team.run([&] { check_cancel(control); }); };
  check();
  const Clock::time_point encoding = Clock::now();
  const std::uint64_t dense_bytes = voxels * sizeof(float);
  const EncodedFile encoded =
      encode_file({source, reading.encode, reading.reading, rows, work, output, journal,
                   options.scene ? visible_values(options.scene->scene) : "", stream,
                   [&] { team.run([&] { start_pass(control, "encode", voxels); }); }, control.notice, control.planned},
                  std::move(request));
  const FilePlan& file = encoded.file;
  const FileSize& size = file.size;
  if (!size.notice.empty() && control.notice) control.notice(size.notice);
  const TreeLayout& layout = file.plan.layout;
  const GridType type = grid_type_of(file.encoding);
  span.emplace(control.trace, "write tree");
  // Most of the file goes to the device while the rest is made.
  const std::jthread writeback([&output] { output.volume().start_writeback(); });
  check();
  GridHead head;
  head.type = type;
  head.breadth_first = type != GridType::fpn;
  head.name = info.dataset.empty() || info.dataset.size() > 255 ? "density" : info.dataset;
  head.voxel_size = info.spacing;
  head.origin = info.origin;
  std::uint32_t checksum = 0;
  team.lead([&] {
    checksum =
        write_tree({*file.tree, rows, *file.choices, *encoded.records, file.fill, layout}, head, output.volume());
  });
  team.follow(checksum);
  team.publish(output.volume());
  check();

  // Finish.
  span.emplace(control.trace, "digest", size.bytes);
  sidecar.grid = {head.name, grid_type_name(head.type), info.extent, info.spacing, info.origin, domain};
  sidecar.background = {static_cast<double>(background.value), background.method, background.share};
  sidecar.budget.kind = size.kind;
  if (size.kind == "rate") sidecar.budget.requested = options.budget.rate;
  if (options.budget.by_error()) sidecar.budget.requested = options.budget.target;
  if (size.kind == "size") sidecar.budget.requested = static_cast<double>(options.budget.bytes);
  sidecar.budget.file_bytes = size.bytes;
  sidecar.budget.dense_float32_bytes = dense_bytes;
  sidecar.budget.rate = static_cast<double>(dense_bytes) / static_cast<double>(size.bytes);
  sidecar.selection = {metric_name(options.metric),
                       fill_name(options.fill),
                       options.brick,
                       static_cast<std::uint64_t>(file.tree->leaves.size()),
                       layout.counts.leaves,
                       file.plan.leaves_by_width};
  sidecar.error = describe_error(file.plan.tiles, encoded.errors, survey.finite, survey);
  if (visibility) {
    sidecar.visible = {options.scene->path, shown.blocks, shown.finite,
                       describe_error(file.plan.seen_tiles, encoded.seen_errors, shown.finite, survey),
                       scene_digest(options.scene->scene)};
  }
  sidecar.macrocells = {kMacrocell, make_lattice(domain, kMacrocell).count, kMacrocellApron};
  sidecar.file = {size.bytes, layout.grid, checksum, digest_of_file(output.volume(), size.bytes, team).hex()};
  sidecar.timing.encode_s = seconds_since(encoding);
  sidecar.timing.total_s = seconds_since(started);
  sidecar.timing.bytes_read = source.bytes_read();
  team.sum<std::uint64_t>({&sidecar.timing.bytes_read, 1});
  sidecar.timing.bytes_written = layout.content_end;
  sidecar.timing.peak_rss_bytes = peak_resident_bytes();
  span.emplace(control.trace, "commit", size.bytes);
  const std::string text = to_json_text(sidecar);
  std::vector<char> record(text.begin(), text.end());
  team.follow(record);  // times are the leading rank's
  check_source(source, team);
  output.commit({record.begin(), record.end()});
  return sidecar;
}

}  // namespace weir
