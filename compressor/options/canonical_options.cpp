#include "compressor/options/canonical_options.h"

#include <array>

#include "compressor/options/conversion_request.h"
#include "format/base/exact_text.h"
#include "format/base/text.h"

namespace weir {
namespace {

using Texts = std::map<std::string, std::string>;

std::string text_of(const std::array<double, 3>& triple) {
  return cat(hex_text(triple[0]), ',', hex_text(triple[1]), ',', hex_text(triple[2]));
}

std::string text_of(const std::optional<std::int64_t>& end) { return end ? cat(*end) : ""; }

std::string text_of(const VolumeRegion& roi) {
  std::string text;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    text += cat(axis == 0 ? "" : ",", text_of(roi.first.at(axis)), ':', text_of(roi.end.at(axis)), " without ",
                roi.ghost.at(axis));
  }
  return text;
}

std::string index_text(const SourceOptions& source) {
  std::string text;
  for (const std::int64_t i : source.index) text += cat(text.empty() ? "" : ",", i);
  for (const AxisChoice& choice : source.index_choices) {
    text += cat(text.empty() ? "" : ",", choice.axis, '=', text_of(choice.first));
    if (choice.range) text += cat(':', text_of(choice.end));
  }
  return text;
}

void add_source(const SourceOptions& source, Texts& texts) {
  if (source.extent) texts["dims"] = cat(source.extent->x, ',', source.extent->y, ',', source.extent->z);
  if (source.type) texts["type"] = std::string(scalar_name(*source.type));
  if (source.big_endian.value_or(false)) texts["endian"] = "big";
  if (source.offset.value_or(0) != 0) texts["offset"] = cat(*source.offset);
  if (!source.dataset.empty()) texts["dataset"] = source.dataset;
  if (const std::string index = index_text(source); !index.empty()) texts["index"] = index;
  if (source.component) texts["component"] = component_text(*source.component);
  for (const std::string& dataset : source.magnitude) {
    std::string& text = texts["magnitude"];
    text += cat(text.empty() ? "" : ",", dataset);
  }
  if (source.level) texts["level"] = cat(*source.level);
  if (source.levels != Levels::composite) texts["levels"] = levels_name(source.levels);
  if (source.upsampling && *source.upsampling != Upsampling::constant) {
    texts["upsample"] = upsampling_name(*source.upsampling);
  }
  if (source.missing_chunks == MissingChunks::error) texts["missing-chunks"] = "error";
  if (source.stack) texts["stack"] = "true";
  if (source.spacing) texts["spacing"] = text_of(*source.spacing);
  if (source.origin) texts["origin"] = text_of(*source.origin);
  if (source.missing) texts["missing"] = stored_value_text(*source.missing);
  if (source.roi && source.roi != VolumeRegion{}) texts["roi"] = text_of(*source.roi);
}

// Returns what becomes of voxels that hold no data: "auto" means the same as --nonfinite, except that its "keep" is
// NaN.
MissingPolicy meant_policy(const ConversionOptions& options) {
  if (options.missing != MissingPolicy::automatic) return options.missing;
  if (options.non_finite == NonFinitePolicy::error) return MissingPolicy::error;
  return options.non_finite == NonFinitePolicy::background ? MissingPolicy::background : MissingPolicy::automatic;
}

void add_method(const ConversionOptions& options, const ConversionOptions& standard, Texts& texts) {
  const std::string budget = budget_text(options.budget);
  if (budget != budget_text(standard.budget)) texts["budget"] = budget;
  const auto add = [&](const char* key, const auto& value, const auto& usual) {
    if (value != usual) texts[key] = cat(static_cast<int>(value));
  };
  add("encoding", options.encoding, standard.encoding);
  add("preview", options.preview, standard.preview);
  add("metric", options.metric, standard.metric);
  add("fill", options.fill, standard.fill);
  add("brick", options.brick, standard.brick);
  add("paper background", options.paper_background, standard.paper_background);
  add("nonfinite", options.non_finite, standard.non_finite);
  add("missing-policy", meant_policy(options), meant_policy(standard));
  if (options.background) texts["background"] = hex_text(static_cast<double>(*options.background));
}

bool has_key(std::span<const ConversionOption> table, std::string_view key) {
  for (const ConversionOption& option : table) {
    if (option.row.key == key) return true;
  }
  return false;
}

}  // namespace

Texts canonical_options(const Texts& options) {
  Texts texts;
  GivenOptions given;
  for (const auto& [key, text] : options) {
    // A scene is not read here: it is compared by its digest, and its file may be gone.
    const bool read = key != "scene" && (has_key(input_options(), key) || has_key(method_options(), key));
    if (read) {
      given[key] = text;
    } else {
      texts[key] = text;
    }
  }
  try {
    const ConversionRequest request = read_conversion_request(given);
    add_source(request.source, texts);
    add_method(request.conversion, read_conversion_request({}).conversion, texts);
  } catch (const Error&) {
    return options;
  }
  return texts;
}

}  // namespace weir
