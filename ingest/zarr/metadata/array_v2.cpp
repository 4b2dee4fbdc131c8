#include "ingest/zarr/metadata/array_v2.h"

#include <utility>

#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/headers/header_text.h"
#include "ingest/zarr/metadata/array_parts.h"
#include "ingest/zarr/metadata/fill_value.h"
#include "ingest/zarr/metadata/zarr_json.h"

namespace weir {
namespace {

// numpy's "<f4" and "|u1".
void read_type(const nlohmann::json& dtype, ZarrArray& array, const std::string& where) {
  if (dtype.is_array()) throw unsupported_type(where, "a structure");
  const std::string text = dtype.is_string() ? dtype.get<std::string>() : json_text(dtype);
  const bool ordered = text.starts_with('<') || text.starts_with('>') || text.starts_with('|');
  const auto type = ordered ? parse_scalar(std::string_view(text).substr(1)) : std::nullopt;
  if (!type || (text.front() == '|' && scalar_bytes(*type) > 1)) throw unsupported_type(where, text);
  array.type = *type;
  array.codecs.big_endian = text.front() == '>';
}

void read_compressor(const nlohmann::json& compressor, ZarrArray& array, const std::string& where) {
  if (compressor.is_null()) return;
  const std::string id = json_string(compressor, "id");
  const auto packer = parse_packer(id);
  if (!packer || *packer == ZarrPacker::crc32c) throw unsupported_codec(where, "compressor", id);
  array.codecs.packers.push_back(*packer);
}

void refuse_filters(const nlohmann::json& filters, const std::string& where) {
  if (!filters.is_array() || filters.empty()) return;
  throw input_error(where, cat("has the filter ", in_quotes(json_string(filters.front(), "id")),
                               ", and no filters are undone here; write the array without filters"));
}

void read_order(const nlohmann::json& order, ZarrArray& array, const std::string& where) {
  if (order == "C") return;
  if (order != "F") throw input_error(where, cat("order is ", json_text(order), ", and must be \"C\" or \"F\""));
  for (std::size_t axis = array.shape.size(); axis-- > 0;) array.codecs.transpose.push_back(axis);
}

}  // namespace

ZarrArray parse_zarr_v2(const nlohmann::json& metadata, nlohmann::json attributes, const std::string& where) {
  if (json_member(metadata, "zarr_format") != 2) {
    throw input_error(where, cat("zarr_format is ", json_text(json_member(metadata, "zarr_format")),
                                 ", and must be 2; the file is damaged"));
  }
  ZarrArray array;
  array.shape = json_extents(json_member(metadata, "shape"), "shape", 0, where);
  array.chunk = json_extents(json_member(metadata, "chunks"), "chunks", 1, where);
  require_same_axes(array.shape, array.chunk, "chunks", where);
  read_type(json_member(metadata, "dtype"), array, where);
  refuse_filters(json_member(metadata, "filters"), where);
  read_compressor(json_member(metadata, "compressor"), array, where);
  read_order(json_member(metadata, "order"), array, where);
  const nlohmann::json& separator = json_member(metadata, "dimension_separator");
  array.keys = {false, separator.is_null() ? '.' : read_separator(separator, "dimension_separator", where)};
  const nlohmann::json& fill = json_member(metadata, "fill_value");
  array.fill_text = json_text(fill);
  if (!fill.is_null()) array.fill = fill_bytes(fill, array.type, array.codecs.big_endian, where);
  array.attributes = std::move(attributes);
  // As xarray names them.
  read_axis_names(json_member(array.attributes, "_ARRAY_DIMENSIONS"), array);
  return array;
}

}  // namespace weir
