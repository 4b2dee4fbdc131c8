#include "format/sidecar/sidecar.h"

#include <array>
#include <chrono>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "format/base/error.h"
#include "format/base/json_text.h"
#include "format/base/text.h"
#include "format/io/output_names.h"
#include "format/sidecar/json_archive.h"

namespace weir {
namespace {

constexpr std::array<const char*, 6> kBitKeys{"1", "2", "4", "8", "16", "32"};
constexpr std::array<const char*, 5> kBlockKeys{"none", "mean", "transform", "lattice", "raw"};

template <typename Archive, typename E>
void describe_error(Archive& archive, E& error) {
  archive.field("mse", error.mse);
  archive.field("rmse", error.rmse);
  archive.field("nmse", error.nmse);
  archive.field("psnr_db", error.psnr_db);
  archive.field("max_abs", error.max_abs);
  archive.field("lossless", error.lossless);
}

template <typename Archive, typename S>
void describe_source(Archive& archive, S& source) {
  archive.field("path", source.path);
  archive.field("format", source.format);
  archive.field("dataset", source.dataset);
  archive.field("extent", source.extent);
  archive.field("type", source.type);
  archive.field("bytes", source.bytes);
  archive.field("mtime", source.mtime);
  archive.field("digest", source.digest);
  archive.field("index", source.index);
  archive.field("axes", source.axes);
  archive.field("units", source.units);
  archive.field("unit_si", source.unit_si);
  archive.field("scale", source.scale);
  archive.field("offset", source.offset);
  archive.optional_field("files_digest", source.files_digest);
  archive.optional_field("values", source.values);
  archive.optional_field("real_path", source.real_path);
  archive.optional_field("long_name", source.long_name);
  archive.optional_field("component", source.component);
  archive.optional_object("level", source.level, [&](auto& level) {
    archive.field("number", level.number);
    archive.field("count", level.count);
  });
  archive.optional_object("time", source.time, [&](auto& time) {
    archive.field("value", time.value);
    archive.field("units", time.units);
    archive.optional_field("calendar", time.calendar);
  });
  archive.optional_field("axis_units", source.axis_units);
  archive.optional_object("irregular_axes", source.irregular_axes, [&](auto& axes) {
    archive.optional_field("x", axes.x);
    archive.optional_field("y", axes.y);
    archive.optional_field("z", axes.z);
  });
  archive.optional_field("reversed_axes", source.reversed_axes);
  archive.optional_field("orientation", source.orientation);
  archive.optional_field("unstored_chunks", source.unstored_chunks);
}

template <typename Archive, typename S>
void describe_selection(Archive& archive, S& selection) {
  archive.field("metric", selection.metric);
  archive.field("fill", selection.fill);
  archive.field("brick", selection.brick);
  archive.field("leaves_total", selection.leaves_total);
  archive.field("leaves_kept", selection.leaves_kept);
  archive.object("bits", [&] {
    for (std::size_t i = 0; i < kBitKeys.size(); ++i) archive.field(kBitKeys[i], selection.bits[i]);
  });
  archive.optional_object("blocks", selection.blocks, [&](auto& blocks) {
    for (std::size_t i = 0; i < kBlockKeys.size(); ++i) archive.field(kBlockKeys[i], blocks[i]);
  });
}

template <typename Archive, typename G>
void describe_gradient(Archive& archive, G& gradient) {
  archive.field("rms", gradient.rms);
  archive.field("relative_rms", gradient.relative_rms);
  archive.field("max_abs", gradient.max_abs);
  archive.field("voxels", gradient.voxels);
  archive.field("left_out", gradient.left_out);
}

// Describes the document's keys once, for writing and for reading: `archive` is a JsonWriter or a JsonReader.
template <typename Archive, typename S>
void describe(Archive& archive, S& s) {
  archive.object("source", [&] { describe_source(archive, s.source); });
  archive.object("grid", [&] {
    archive.field("name", s.grid.name);
    archive.field("type", s.grid.type);
    archive.field("extent", s.grid.extent);
    archive.field("voxel_size", s.grid.voxel_size);
    archive.field("origin", s.grid.origin);
    archive.field("index_bbox", s.grid.index_bbox);
  });
  archive.field("value_range", s.value_range);
  archive.object("nonfinite", [&] {
    archive.field("count", s.nonfinite.count);
    archive.field("policy", s.nonfinite.policy);
  });
  archive.object("missing", [&] {
    archive.field("count", s.missing.count);
    archive.field("values", s.missing.values);
    archive.optional_field("policy", s.missing.policy);
  });
  archive.object("conversion_loss", [&] {
    archive.field("inexact", s.conversion_loss.inexact);
    archive.field("overflow", s.conversion_loss.overflow);
    archive.field("max_abs_error", s.conversion_loss.max_abs_error);
  });
  archive.optional_object("zeros", s.zeros, [&](auto& zeros) {
    archive.field("count", zeros.count);
    archive.field("lost", zeros.lost);
  });
  archive.object("background", [&] {
    archive.field("value", s.background.value);
    archive.field("method", s.background.method);
    archive.field("share", s.background.share);
  });
  archive.object("histogram", [&] {
    archive.field("min", s.histogram.min);
    archive.field("max", s.histogram.max);
    archive.field("counts", s.histogram.counts);
  });
  archive.object("budget", [&] {
    archive.field("kind", s.budget.kind);
    archive.field("requested", s.budget.requested);
    archive.field("file_bytes", s.budget.file_bytes);
    archive.field("dense_float32_bytes", s.budget.dense_float32_bytes);
    archive.field("rate", s.budget.rate);
  });
  archive.object("selection", [&] { describe_selection(archive, s.selection); });
  archive.object("error", [&] {
    describe_error(archive, s.error);
    archive.optional_object("gradient", s.gradient, [&](auto& gradient) { describe_gradient(archive, gradient); });
  });
  archive.optional_object("error_preview", s.error_preview, [&](auto& error) { describe_error(archive, error); });
  archive.optional_object("visible", s.visible, [&](auto& visible) {
    archive.field("scene", visible.scene);
    archive.field("blocks", visible.blocks);
    archive.field("voxels", visible.voxels);
    describe_error(archive, visible.error);
    archive.optional_field("scene_digest", visible.scene_digest);
  });
  archive.optional_object("packed", s.packed, [&](auto& packed) { archive.field("preview", packed.preview); });
  archive.object("macrocells", [&] {
    archive.field("cell", s.macrocells.cell);
    archive.field("dims", s.macrocells.dims);
    archive.field("apron", s.macrocells.apron);
  });
  archive.object("timing", [&] {
    archive.field("survey_s", s.timing.survey_s);
    archive.field("encode_s", s.timing.encode_s);
    archive.field("total_s", s.timing.total_s);
    archive.field("bytes_read", s.timing.bytes_read);
    archive.field("bytes_written", s.timing.bytes_written);
    archive.field("peak_rss_bytes", s.timing.peak_rss_bytes);
  });
  archive.object("file", [&] {
    archive.field("bytes", s.file.bytes);
    archive.field("grid_offset", s.file.grid_offset);
    archive.hex_field("head_checksum", s.file.head_checksum);
    archive.field("digest", s.file.digest);
  });
  archive.object("weir", [&] {
    archive.field("version", s.weir.version);
    archive.field("commit", s.weir.commit);
    archive.field("options", s.weir.options);
  });
}

// Copies keys of sidecars of weir 0.2 to the places that they have now.
void move_older_keys(nlohmann::json& document) {
  if (!document.contains("packed") || !document.contains("selection")) return;
  nlohmann::json& packed = document["packed"];
  nlohmann::json& selection = document["selection"];
  if (!packed.is_object() || !selection.is_object()) return;
  if (packed.contains("blocks")) selection.emplace("blocks", packed["blocks"]);
  if (packed.contains("error_preview")) document.emplace("error_preview", packed["error_preview"]);
}

constexpr int kMaxSidecarDepth = 16;  ///< twice the depth of a sidecar

}  // namespace

std::string sidecar_path(const std::string& volume_path) { return cat(volume_path, kSidecarEnding); }

std::string to_json_text(const Sidecar& sidecar) {
  JsonWriter writer;
  writer.field("weir_sidecar", kSidecarVersion);
  describe(writer, sidecar);
  std::string text = "{";
  const char* separator = "\n";
  for (const auto& [key, value] : writer.document().items()) {
    text += cat(separator, "  \"", key, "\": ", json_text(value));
    separator = ",\n";
  }
  return text + "\n}\n";
}

Sidecar parse_sidecar(std::string_view text, const std::string& path) {
  nlohmann::json document;
  // The depth is checked while parsing, because a level of nesting takes 80 times the memory of its byte.
  const auto check_depth = [&](int depth, nlohmann::json::parse_event_t, const nlohmann::json&) {
    if (depth > kMaxSidecarDepth) {
      throw Error(ErrorKind::input, cat(path, ": nested deeper than ", kMaxSidecarDepth,
                                        " levels, no sidecar is; write it again with weir convert"));
    }
    return true;
  };
  try {
    document = nlohmann::json::parse(text, check_depth);
  } catch (const nlohmann::json::parse_error& error) {
    throw Error(ErrorKind::input,
                cat(path, ": at byte ", error.byte - 1, ": not valid JSON; write the sidecar again with weir convert"));
  } catch (const nlohmann::json::out_of_range&) {
    throw Error(ErrorKind::input,
                path + ": a number is beyond the range of double; write the sidecar again with weir convert");
  }
  if (!document.is_object()) throw Error(ErrorKind::input, path + ": not a JSON object; give the sidecar of a volume");
  move_older_keys(document);
  JsonReader reader(document, path);
  std::int64_t version = 0;
  reader.field("weir_sidecar", version);
  if (version != kSidecarVersion) {
    throw Error(ErrorKind::input, cat(path, ": key weir_sidecar: version ", version, ", but this weir reads version ",
                                      kSidecarVersion, "; use the weir that wrote it"));
  }
  Sidecar sidecar;
  describe(reader, sidecar);
  return sidecar;
}

std::string utc_text(std::int64_t nanoseconds) {
  using namespace std::chrono;
  // Splits the time into seconds and a rest. The first second that 64-bit nanoseconds reach begins before their
  // earliest time, so neither it nor its midnight fits 64-bit nanoseconds.
  constexpr std::int64_t kSecond = 1'000'000'000;
  std::int64_t rest = nanoseconds % kSecond;
  if (rest < 0) rest += kSecond;
  const std::int64_t before = nanoseconds / kSecond - (nanoseconds % kSecond < 0 ? 1 : 0);
  const seconds second(before);
  const auto day = floor<days>(second);
  const year_month_day date{sys_days(day)};
  const hh_mm_ss clock(second - day);
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%04d-%02u-%02uT%02d:%02d:%02d.%09dZ", static_cast<int>(date.year()),
                static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()),
                static_cast<int>(clock.hours().count()), static_cast<int>(clock.minutes().count()),
                static_cast<int>(clock.seconds().count()), static_cast<int>(rest));
  return text.data();
}

}  // namespace weir
