#include "tools/report/recorded_input.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <utility>

#include "compressor/options/conversion_request.h"
#include "format/base/error.h"
#include "format/base/text.h"
#include "format/io/real_path.h"
#include "format/sidecar/find_sidecar.h"
#include "format/sidecar/read_sidecar.h"
#include "ingest/raw/raw_name.h"
#include "ingest/source/extent.h"
#include "ingest/source_registry.h"
#include "ingest/values/axis_placement.h"

namespace weir {
namespace {

using Note = std::function<void(const char* option, const std::string& text)>;

/// Takes the layout of a raw file from `said`, the options of the conversion, where neither `options` nor the file's
/// name gives it.
void take_raw_layout(const std::string& input, const std::map<std::string, std::string>& said, SourceOptions& options,
                     const Note& note) {
  const auto name = parse_raw_name(input);
  const auto take = [&](const char* key, bool wanted) {
    if (!wanted || !said.contains(key)) return;
    const SourceOptions as_said = read_conversion_request({{key, said.at(key)}}).source;
    if (name && as_said.type && as_said.type != name->type) return;
    if (as_said.extent) options.extent = as_said.extent;
    if (as_said.type) options.type = as_said.type;
    if (as_said.big_endian && !options.big_endian) options.big_endian = as_said.big_endian;  // a type may say it, too
    if (as_said.offset) options.offset = as_said.offset;
    note(cat("--", key).c_str(), said.at(key));
  };
  take("dims", !options.extent && !name);
  take("type", !options.type);
  take("endian", !options.big_endian && !(name && name->big_endian));
  take("offset", !options.offset);
}

}  // namespace

std::string index_text(const std::vector<std::int64_t>& index) {
  std::string text;
  for (const std::int64_t position : index) text += cat(text.empty() ? "" : ",", position);
  return text;
}

InputRecord read_input_record(const NvdbFile& file) {
  InputRecord record{find_sidecar(file.path()), {}, {}};
  if (!is_there(record.path)) return record;
  constexpr const char* kWithout = "; the source is read without what it records";
  try {
    record.sidecar = own_sidecar(file);
    if (!record.sidecar) record.unusable = cat(record.path, ": is of another volume than ", file.path(), kWithout);
  } catch (const Error& error) {
    record.unusable = cat(error.what(), kWithout);
  }
  return record;
}

std::string take_recorded_input(const std::string& input, const InputRecord& recorded, const GivenOptions& given,
                                SourceOptions& options) {
  const std::optional<Sidecar>& record = recorded.sidecar;
  if (!record) return {};
  std::string taken;
  const auto note = [&taken](const char* option, const std::string& text) {
    taken += cat(taken.empty() ? "" : " ", option, text.empty() ? "" : " ", text);
  };
  const auto& said = record->weir.options;
  if (!options.stack && said.contains("stack") && !std::filesystem::exists(input)) {  // a pattern
    options.stack = true;
    note("--stack", "");
  }
  if (!options.stack && record->source.format != format_of(input).name) return {};
  if (options.stack == said.contains("stack")) take_raw_layout(input, said, options, note);
  const bool names_volume = !options.dataset.empty() || !options.magnitude.empty() || options.component;
  if (said.contains("magnitude") && !names_volume && !options.stack) {
    options.magnitude = split(said.at("magnitude"), ',');
    note("--magnitude", said.at("magnitude"));
  }
  const bool same_dataset =
      options.magnitude.empty() && (options.dataset.empty() || options.dataset == record->source.dataset ||
                                    '/' + options.dataset == record->source.dataset);
  if (options.dataset.empty() && options.magnitude.empty() && !record->source.dataset.empty()) {
    options.dataset = record->source.dataset;
    note("--dataset", options.dataset);
  }
  const bool same_place = same_dataset || !options.magnitude.empty();
  if (same_place && options.index.empty() && options.index_choices.empty() && !record->source.index.empty()) {
    options.index = record->source.index;
    note("--index", index_text(options.index));
  }
  if (same_dataset && !options.component && !record->source.component.empty()) {
    options.component = parse_component(record->source.component);
    note("--component", record->source.component);
  }
  if (record->source.level && (!given.contains("levels") || options.levels == Levels::separate)) {
    options.levels = Levels::separate;
    options.own_level = record->source.level->number;
    note("--levels", cat("separate (level ", record->source.level->number, ")"));
  }
  for (const char* const key : {"level", "upsample"}) {
    if (!said.contains(key) || given.contains(key)) continue;
    const SourceOptions as_said = read_conversion_request({{key, said.at(key)}}).source;
    if (as_said.level) options.level = as_said.level;
    if (as_said.upsampling) options.upsampling = as_said.upsampling;
    note(cat("--", key).c_str(), said.at(key));
  }
  if (!options.spacing && said.contains("spacing")) {
    options.spacing = read_conversion_request({{"spacing", said.at("spacing")}}).source.spacing;
    note("--spacing", said.at("spacing"));
  }
  if (!options.missing && said.contains("missing")) {
    options.missing = parse_stored_value(said.at("missing"));
    note("--missing", said.at("missing"));
  }
  if (record->missing.policy == "keep" && record->missing.count > 0 && !given.contains("missing-policy")) {
    options.keeps_missing = true;
    note("--missing-policy", "keep");
  }
  if (!options.roi && (said.contains("roi") || said.contains("ghost"))) {
    options.roi = record->grid.index_bbox;
    note("--roi", box_text(record->grid.index_bbox));
  }
  return taken;
}

std::string changed_source_note(const InputRecord& recorded, const SourceInfo& source) {
  const std::optional<Sidecar>& record = recorded.sidecar;
  if (!record || record->source.format != source.format) return {};
  const std::string mtime = utc_text(source.mtime_ns);
  if (record->source.path != source.path || record->source.mtime == mtime) return {};
  return cat("is of ", mtime, ", and was of ", record->source.mtime, " when it was converted, as ", recorded.path,
             " records");
}

std::string other_input_note(const InputRecord& recorded, const SourceInfo& source) {
  const std::optional<Sidecar>& record = recorded.sidecar;
  if (!record || record->source.format != source.format) return {};
  std::string was;
  std::string is;
  const auto compare = [&](const char* option, const std::string& before, const std::string& now) {
    if (before == now) return;
    for (const auto& [text, value] : {std::pair(&was, &before), std::pair(&is, &now)}) {
      *text += cat(text->empty() ? "" : " ", value->empty() ? "no " : "", option, value->empty() ? "" : " ", *value);
    }
  };
  compare("--dataset", record->source.dataset, source.dataset);
  compare("--index", index_text(record->source.index), index_text(source.index));
  compare("--component", record->source.component, source.details.component);
  compare("--spacing", vector_text(record->grid.voxel_size), vector_text(source.spacing));
  if (was.empty()) return {};
  return cat("was converted with ", was, ", as ", recorded.path, " records, and is compared with ", is);
}

}  // namespace weir
