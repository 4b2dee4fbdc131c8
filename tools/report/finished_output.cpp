#include "tools/report/finished_output.h"

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "compressor/conversion_identity.h"
#include "compressor/describe_conversion.h"
#include "compressor/options/canonical_options.h"
#include "format/base/error.h"
#include "format/base/text.h"
#include "format/io/real_path.h"
#include "format/nanovdb/nvdb_checksum.h"
#include "format/nanovdb/nvdb_file.h"
#include "format/output/output_place.h"
#include "format/sidecar/is_of.h"
#include "format/sidecar/read_sidecar.h"
#include "ingest/raw/raw_name.h"

namespace weir {
namespace {

// Returns the record of `source` and `options` as a sidecar would give it back: JSON does not hold every byte that a
// path may have.
Sidecar expected_record(const SourceInfo& source, const ConversionOptions& options) {
  Sidecar record;
  record.source.path = source.path;
  record.source.real_path = real_path_of(source);
  record.source.dataset = source.dataset;
  record.source.mtime = utc_text(source.mtime_ns);
  record.source.files_digest = source.files_digest;
  if (options.scene) {
    record.visible = Sidecar::Visible();
    record.visible->scene_digest = scene_digest(options.scene->scene);
  }
  if (options.certify == Certify::gradient) record.gradient = Sidecar::GradientError();
  record.weir.options = options.provenance.options;
  return parse_sidecar(to_json_text(record), source.path);
}

// Returns the options that describe what the source does not say itself. Place, chosen volume and region are left out,
// because their results are compared instead: "a" and "/a", -1 and the last position, and a spacing equal to the
// file's own are the same.
std::map<std::string, std::string> compared_options(const std::map<std::string, std::string>& options,
                                                    const SourceInfo& source) {
  std::map<std::string, std::string> compared = canonical_options(deciding_options(options));
  for (const char* key : {"index", "spacing", "origin", "roi", "ghost"}) compared.erase(key);
  if (!source.dataset.empty()) compared.erase("dataset");
  const auto name = source.format == "raw" ? parse_raw_name(source.path) : std::nullopt;
  if (!name) return compared;
  compared.erase("dims");  // an option that contradicts the name is refused
  if (name->type) compared.erase("type");
  if (name->type && name->big_endian) compared.erase("endian");
  return compared;
}

bool same_place(const Sidecar::Grid& grid, const SourceInfo& source) {
  return grid.index_bbox == source.domain() && grid.voxel_size == source.spacing && grid.origin == source.origin;
}

bool same_file(const std::string& a, const std::string& b) {
  std::error_code not_there;
  return a == b || std::filesystem::equivalent(a, b, not_there);
}

// Returns whether both records name one file. "a.raw", "./a.raw" and the absolute path name one file. "a.raw" in two
// working directories names two files, if both exist; otherwise a directory may have been renamed or moved to another
// machine.
bool same_source(const Sidecar::Source& found, const Sidecar::Source& expected) {
  const std::string& real = found.real_path;  // weir 0.1 did not say it
  if (found.path == expected.path) return real.empty() || !is_there(real) || same_file(real, expected.real_path);
  return same_file(real.empty() ? found.path : real, expected.real_path) || same_file(found.path, expected.path);
}

std::string difference(const Sidecar& found, const Sidecar& expected, const SourceInfo& source) {
  if (found.source.bytes != source.file_bytes) {
    return cat("made when ", source.path, " had ", found.source.bytes, " bytes, now ", source.file_bytes);
  }
  if (found.source.mtime != expected.source.mtime) {
    return cat("made of ", source.path, " as of ", found.source.mtime, ", now ", expected.source.mtime);
  }
  if (found.source.files_digest != expected.source.files_digest) {
    return cat("made of other files of ", source.path, ", or as they were before");
  }
  const std::int64_t level = source.details.level ? source.details.level->number : -1;
  if (found.source.dataset != expected.source.dataset || found.source.index != source.index ||
      (found.source.level ? found.source.level->number : -1) != level || found.source.format != source.format ||
      found.source.extent != source.extent) {
    return cat("made of another volume of ", source.path);
  }
  if (!same_place(found.grid, source)) return "made of another region, or with another spacing or origin";
  if (compared_options(found.weir.options, source) != compared_options(expected.weir.options, source)) {
    return "made with other options";
  }
  const std::string scene = expected.visible ? expected.visible->scene_digest : "";
  if ((found.visible ? found.visible->scene_digest : "") != scene) return "made for a scene that said something else";
  if (expected.gradient && !found.gradient) return "its sidecar does not certify the gradient";
  return {};
}

// Returns which file of the source changed after the sidecar was written; empty: none. The sidecar was written after
// the last look at the source. A file that took the source's place with its size and time (cp -p, rsync -t), or that
// was rewritten and had its time set back, has a newer status time (ctime), which no program can set.
std::string changed_since(const std::string& record_path, const SourceInfo& source) {
  const FileState record = look_at_file(record_path);
  for (const FileState& file : source.files) {
    if (touched_since(file, record)) {
      return cat(file.path, " was replaced or changed at ", utc_text(file.ctime_ns),
                 ", after the volume was made of it");
    }
  }
  return {};
}

// Returns why the volume is not the one that the sidecar describes; empty if it is.
std::string broken(const std::string& output, const Sidecar& sidecar) {
  try {
    const NvdbFile file(output);
    const NvdbGrid& grid = file.grid();
    const bool whole = computed_head_checksum(grid) == sidecar.file.head_checksum && is_of(sidecar, file);
    return whole ? "" : cat(output, ": does not agree with its sidecar");
  } catch (const Error& error) {
    return error.what();
  }
}

}  // namespace

FinishedOutput find_output(const SourceInfo& source, const ConversionOptions& options) {
  const std::string& output = options.output;
  const std::string record_path = sidecar_path(output);
  if (!is_there(record_path)) {
    if (!is_there(output)) return {};
    return {FinishedOutput::State::foreign, {}, "has no sidecar, so that weir cannot say what it is"};
  }
  Sidecar found;
  try {
    found = read_sidecar(record_path);
  } catch (const Error& error) {
    const bool unreadable = error.kind() == ErrorKind::io;
    return {unreadable ? FinishedOutput::State::unreadable : FinishedOutput::State::foreign, {}, error.what()};
  }
  const Sidecar expected = expected_record(source, options);
  if (!same_source(found.source, expected.source)) {
    const std::string& made_of = found.source.real_path.empty() ? found.source.path : found.source.real_path;
    return {FinishedOutput::State::foreign, {}, cat("was made of ", made_of)};
  }
  std::string reason = difference(found, expected, source);
  if (reason.empty()) reason = changed_since(record_path, source);
  if (reason.empty()) reason = broken(output, found);
  const auto state = reason.empty() ? FinishedOutput::State::done : FinishedOutput::State::stale;
  return {state, std::move(found), std::move(reason)};
}

void check_output(const std::string& input, const std::string& output) {
  std::error_code ignored;
  if (std::filesystem::equivalent(input, output, ignored)) {
    throw Error(ErrorKind::usage, cat(output, ": is the input; choose another output"));
  }
  require_volume_name(output);
  if (std::filesystem::is_directory(output, ignored)) {
    throw Error(ErrorKind::usage, cat(output, ": is a directory; name a file in it"));
  }
}

}  // namespace weir
