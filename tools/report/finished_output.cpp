#include "tools/report/finished_output.h"

#include <filesystem>

#include "compressor/conversion_identity.h"
#include "format/base/error.h"
#include "format/base/text.h"
#include "format/io/real_path.h"
#include "format/nanovdb/nvdb_checksum.h"
#include "format/nanovdb/nvdb_file.h"
#include "tools/report/read_sidecar.h"

namespace weir {
namespace {

// `source` and `options` as a sidecar gives them back: JSON does not hold every byte that a path may.
Sidecar expected_record(const SourceInfo& source, const ConversionOptions& options) {
  Sidecar record;
  record.source.path = source.path;
  record.source.dataset = source.dataset;
  record.source.mtime = utc_text(source.mtime_ns);
  record.source.files_digest = source.files_digest;
  if (options.scene) {
    record.visible = Sidecar::Visible();
    record.visible->scene_digest = scene_digest(options.scene->scene);
  }
  record.weir.options = deciding_options(options.provenance.options);
  return parse_sidecar(to_json_text(record), source.path);
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
  if (found.source.dataset != expected.source.dataset || found.source.index != source.index ||
      found.source.format != source.format || found.source.extent != source.extent) {
    return cat("made of another volume of ", source.path);
  }
  if (deciding_options(found.weir.options) != expected.weir.options) return "made with other options";
  const std::string scene = expected.visible ? expected.visible->scene_digest : "";
  if ((found.visible ? found.visible->scene_digest : "") != scene) return "made for a scene that said something else";
  return {};
}

// A file that took the source's place, with its size and time (cp -p, rsync -t), or was rewritten and had its time set
// back, got its status at that moment, which no program sets. The sidecar was written after the last look at the
// source.
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

// Empty where the volume is the one that the sidecar describes.
std::string broken(const std::string& output, const Sidecar& sidecar) {
  try {
    const NvdbFile file(output);
    const NvdbGrid& grid = file.grid();
    const bool whole = file.bytes().size() == sidecar.file.bytes &&
                       grid.head_checksum() == sidecar.file.head_checksum &&
                       computed_head_checksum(grid) == sidecar.file.head_checksum;
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
    return {FinishedOutput::State::foreign, {}, error.what()};
  }
  const Sidecar expected = expected_record(source, options);
  if (found.source.path != expected.source.path) {
    return {FinishedOutput::State::foreign, {}, cat("was made of ", found.source.path)};
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
  if (std::filesystem::is_directory(output, ignored)) {
    throw Error(ErrorKind::usage, cat(output, ": is a directory; name a file in it"));
  }
}

}  // namespace weir
