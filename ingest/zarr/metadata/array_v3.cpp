#include "ingest/zarr/metadata/array_v3.h"

#include <algorithm>
#include <array>

#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/headers/header_text.h"
#include "ingest/zarr/metadata/array_parts.h"
#include "ingest/zarr/metadata/codec_list.h"
#include "ingest/zarr/metadata/fill_value.h"
#include "ingest/zarr/metadata/zarr_json.h"

namespace weir {
namespace {

void require_array(const nlohmann::json& metadata, const std::string& where) {
  if (json_member(metadata, "zarr_format") != 3) {
    throw input_error(where, cat("zarr_format is ", json_text(json_member(metadata, "zarr_format")),
                                 ", and must be 3; the file is damaged"));
  }
  if (json_member(metadata, "node_type") != "array") {
    throw input_error(where, cat("node_type is ", json_text(json_member(metadata, "node_type")),
                                 ", and must be \"array\"; the file is damaged"));
  }
}

void refuse_extensions(const nlohmann::json& metadata, const std::string& where) {
  constexpr std::array<std::string_view, 12> kKnown{
      "zarr_format", "node_type",  "shape",      "data_type",       "chunk_grid",           "chunk_key_encoding",
      "codecs",      "fill_value", "attributes", "dimension_names", "storage_transformers", "consolidated_metadata"};
  const nlohmann::json& transformers = json_member(metadata, "storage_transformers");
  if (transformers.is_array() && !transformers.empty()) {
    throw input_error(where, cat("has the storage transformer ", in_quotes(extension_name(transformers.front())),
                                 ", and none is read here; write the array without"));
  }
  for (const auto& [key, value] : metadata.items()) {
    if (std::find(kKnown.begin(), kKnown.end(), key) != kKnown.end()) continue;
    if (json_member(value, "must_understand") == false) continue;
    throw input_error(where, cat("has the member ", in_quotes(key), ", which weir does not know and must understand"));
  }
}

ScalarType read_type(const nlohmann::json& type, const std::string& where) {
  const std::string name = type.is_string() ? type.get<std::string>() : extension_name(type);
  if (name == "bool") return ScalarType::uint8;  // one byte, 0 or 1
  const auto known = parse_scalar(name);
  // Version 3 has only full names, not numpy's or C's.
  if (!known || scalar_name(*known) != name) throw unsupported_type(where, name.empty() ? json_text(type) : name);
  return *known;
}

std::vector<std::int64_t> read_chunk(const nlohmann::json& grid, const std::string& where) {
  if (extension_name(grid) != "regular") {
    throw input_error(where, cat("has the chunk grid ", in_quotes(extension_name(grid)),
                                 ", and only regular ones are read; write the array with chunks of one shape"));
  }
  return json_extents(json_member(json_member(grid, "configuration"), "chunk_shape"), "chunk_shape", 1, where);
}

ZarrChunkKeys read_keys(const nlohmann::json& encoding, const std::string& where) {
  const std::string name = extension_name(encoding);
  if (name != "default" && name != "v2") {
    throw input_error(where, cat("has the chunk key encoding ", in_quotes(name), ", and must have default or v2"));
  }
  ZarrChunkKeys keys{name == "default", name == "default" ? '/' : '.'};
  const nlohmann::json& separator = json_member(json_member(encoding, "configuration"), "separator");
  if (!separator.is_null()) keys.separator = read_separator(separator, "separator", where);
  return keys;
}

// Throws Error(input) unless `names`, the member dimension_names, is null or a list of one name or null for each axis.
void require_axis_names(const nlohmann::json& names, std::size_t axes, const std::string& where) {
  const auto is_name = [](const nlohmann::json& name) { return name.is_string() || name.is_null(); };
  if (names.is_null()) return;
  if (names.is_array() && names.size() == axes && std::all_of(names.begin(), names.end(), is_name)) return;
  throw input_error(where, cat("dimension_names is ", json_text(names), ", and must be a list of one name or null for ",
                               "each of the ", axes, " axes of shape; the file is damaged"));
}

}  // namespace

ZarrArray parse_zarr_v3(const nlohmann::json& metadata, const std::string& where) {
  require_array(metadata, where);
  ZarrArray array;
  array.shape = json_extents(json_member(metadata, "shape"), "shape", 0, where);
  array.type = read_type(json_member(metadata, "data_type"), where);
  refuse_extensions(metadata, where);
  array.chunk = read_chunk(json_member(metadata, "chunk_grid"), where);
  require_same_axes(array.shape, array.chunk, "chunk_shape", where);
  array.keys = read_keys(json_member(metadata, "chunk_key_encoding"), where);
  read_codecs(json_member(metadata, "codecs"), array, where);
  const nlohmann::json fill =
      number_of_fill(json_member(metadata, "fill_value"), json_member(metadata, "data_type") == "bool", where);
  array.fill_text = json_text(fill);
  array.fill = fill_bytes(fill, array.type, array.values().big_endian, where);
  array.attributes = json_member(metadata, "attributes");
  const nlohmann::json& names = json_member(metadata, "dimension_names");
  require_axis_names(names, array.shape.size(), where);
  read_axis_names(names, array);
  return array;
}

}  // namespace weir
