#include "compressor/conversion_identity.h"

#include <array>
#include <cstdint>
#include <span>

#include "format/base/exact_text.h"
#include "format/base/text.h"
#include "format/io/digest.h"
#include "format/io/real_path.h"

namespace weir {
namespace {

// Returns a digest of the inodes, sizes and times of `files`. No copy of a file shares them, even if size and
// modification time agree. The device's number is left out because it may change when the machine restarts.
std::string states_of(std::span<const FileState> files) {
  DigestStream states;
  for (const FileState& file : files) {
    const std::array<std::uint64_t, 4> state{file.inode, file.bytes, static_cast<std::uint64_t>(file.mtime_ns),
                                             static_cast<std::uint64_t>(file.ctime_ns)};
    states.update(piece_digest(std::as_bytes(std::span(state))));
  }
  return states.digest().hex();
}

std::string position(const Index3& i) { return cat(i.x, ',', i.y, ',', i.z); }

std::string mapping_text(const ValueMapping& mapping) {
  std::string text = cat(hex_text(mapping.scale), ' ', hex_text(mapping.offset));
  for (const StoredValue& value : mapping.missing) text += cat(' ', stored_value_text(value));
  if (mapping.keeps_missing) text += " as data";
  return text;
}

}  // namespace

std::map<std::string, std::string> deciding_options(std::map<std::string, std::string> options) {
  for (const char* name : {"output", "memory", "threads", "bandwidth", "work-dir", "within", "direct-io", "overwrite",
                           "backend", "certify"})
    options.erase(name);
  return options;
}

std::string visible_values(const Scene& scene) {
  const SceneVolume& volume = scene.volume;
  std::string text(render_mode_name(scene.mode));
  if (volume.iso) text += cat(" iso ", hex_text(*volume.iso));
  if (volume.range) text += cat(" range ", hex_text((*volume.range)[0]), ' ', hex_text((*volume.range)[1]));
  if (volume.region) text += cat(" region ", position(volume.region->lo), ' ', position(volume.region->hi));
  for (const OpacityPoint& point : volume.opacity)
    text += cat(' ', hex_text(point.position), ':', hex_text(point.opacity));
  return text;
}

std::string scene_digest(const Scene& scene) {
  const std::string text = visible_values(scene);
  return piece_digest(std::as_bytes(std::span(text))).hex();
}

ConversionIdentity identify_conversion(const SourceInfo& source, const ConversionOptions& options) {
  std::string index;
  for (const std::int64_t i : source.index) index += cat(i, ' ');
  ConversionIdentity identity{
      // Absolute: another working directory may hold another file of the same name, size and time.
      {"source", absolute_real_path(source.path)},
      {"source bytes", cat(source.file_bytes)},
      {"source modified (ns)", cat(source.mtime_ns)},
      {"source files", source.files_digest},
      {"source states", states_of(source.files)},
      {"format", source.format},
      {"dataset", source.dataset},
      {"index", index},
      {"component", source.details.component},
      {"levels", source.details.levels},
      {"extent", position(source.extent)},
      {"index origin", position(source.index_origin)},
      {"type", std::string(scalar_name(source.type))},
      {"value mapping", mapping_text(source.mapping)},
      {"budget", budget_text(options.budget)},
      {"encoding", encoding_name(options.encoding)},
      {"preview", preview_name(options.preview)},
      {"metric", metric_name(options.metric)},
      {"fill", fill_name(options.fill)},
      {"brick", cat(options.brick)},
      {"scene", options.scene ? options.scene->path : ""},
      {"background", options.background ? hex_text(static_cast<double>(*options.background)) : "found"},
      {"paper background", options.paper_background ? "yes" : "no"},
      {"nonfinite", policy_name(options.non_finite)},
      {"missing policy", missing_policy_name(options)},
      {"weir", cat(options.provenance.version, ' ', options.provenance.commit)},
  };
  for (const auto& [name, value] : deciding_options(options.provenance.options)) identity["--" + name] = value;
  return identity;
}

}  // namespace weir
