#include "ingest/zarr/metadata/array_v2.h"

#include <utility>

#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/headers/header_text.h"
#include "ingest/values/decode_values.h"
#include "ingest/zarr/metadata/array_parts.h"
#include "ingest/zarr/metadata/fill_value.h"
#include "ingest/zarr/metadata/zarr_json.h"

namespace weir {
namespace {

// Reads a type in numpy's notation, for example "<f4" or "|u1".
void read_type(const nlohmann::json& dtype, ZarrArray& array, const std::string& where) {
  if (dtype.is_array()) throw unsupported_type(where, "a structure");
  const std::string text = dtype.is_string() ? dtype.get<std::string>() : json_text(dtype);
  const bool ordered = text.starts_with('<') || text.starts_with('>') || text.starts_with('|');
  if (text == "|b1") {  // one byte, 0 or 1
    array.type = ScalarType::uint8;
    return;
  }
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

// Only a delta of one type as wide as the array's is read: other deltas and filters change the number of bytes of a
// value, or round it.
ZarrFilter read_delta(const nlohmann::json& filter, const ZarrArray& array, const std::string& where) {
  const std::string dtype = json_string(filter, "dtype");
  const std::string astype = json_string(filter, "astype");
  const auto type = parse_scalar(dtype.empty() ? std::string_view() : std::string_view(dtype).substr(1));
  const bool narrow = type == ScalarType::float16 || type == ScalarType::bfloat16;
  if (!type || narrow || scalar_bytes(*type) != scalar_bytes(array.type) || (!astype.empty() && astype != dtype)) {
    const std::string types =
        dtype.empty() ? std::string("without a dtype") : cat("from ", dtype, " to ", astype.empty() ? dtype : astype);
    throw input_error(where, cat("has the filter 'delta' ", types,
                                 ", and it is undone of one type, an integer or float32 or float64 as wide as the "
                                 "array's; write the array without it"));
  }
  return {ZarrFilter::Kind::delta, 1, *type, dtype.front() == '>'};
}

ZarrFilter read_shuffle(const nlohmann::json& filter, const std::string& where) {
  constexpr std::int64_t kUsual = 4;
  const nlohmann::json& size = json_member(filter, "elementsize");
  const std::int64_t bytes = size.is_number_integer() ? size.get<std::int64_t>() : size.is_null() ? kUsual : 0;
  if (bytes >= 1 && bytes <= 256) return {ZarrFilter::Kind::shuffle, static_cast<std::size_t>(bytes)};
  throw input_error(where, cat("elementsize of the filter 'shuffle' is ", json_text(size),
                               ", and must be a whole number from 1 to 256; the file is damaged"));
}

void read_filters(const nlohmann::json& filters, ZarrArray& array, const std::string& where) {
  constexpr std::size_t kMostFilters = 16;
  if (filters.is_null()) return;
  if (!filters.is_array()) {
    throw input_error(where,
                      cat("filters is ", json_text(filters), ", and must be null or a list; the file is damaged"));
  }
  if (filters.size() > kMostFilters) {
    throw input_error(where,
                      cat("has ", filters.size(), " filters, more than ", kMostFilters, "; the file is damaged"));
  }
  for (const nlohmann::json& filter : filters) {
    const std::string id = json_string(filter, "id");
    if (id != "delta" && id != "shuffle") {
      throw input_error(where, cat("has the filter ", in_quotes(id),
                                   ", and weir undoes delta and shuffle; write the array without it"));
    }
    array.codecs.filters.push_back(id == "delta" ? read_delta(filter, array, where) : read_shuffle(filter, where));
  }
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
  read_filters(json_member(metadata, "filters"), array, where);
  read_compressor(json_member(metadata, "compressor"), array, where);
  read_order(json_member(metadata, "order"), array, where);
  const nlohmann::json& separator = json_member(metadata, "dimension_separator");
  array.keys = {false, separator.is_null() ? '.' : read_separator(separator, "dimension_separator", where)};
  const nlohmann::json fill =
      number_of_fill(json_member(metadata, "fill_value"), json_member(metadata, "dtype") == "|b1", where);
  array.fill_text = json_text(fill);
  if (!fill.is_null()) array.fill = fill_bytes(fill, array.type, array.codecs.big_endian, where);
  array.attributes = std::move(attributes);
  // xarray stores the names of the axes in this attribute.
  const nlohmann::json& dimensions = json_member(array.attributes, "_ARRAY_DIMENSIONS");
  read_axis_names(dimensions, array);
  // xarray writes _FillValue as fill_value, null if there is none, and reads it back the same way
  // (open_store_variable in xarray/backends/zarr.py). Other writers use 0 by default, so there the fill value is an
  // ordinary value.
  if (dimensions.is_array() && json_member(array.attributes, "_FillValue").is_null()) {
    array.missing_fill = number_in_fill(fill);
    // The missing value must equal the stored value, which may have fewer bits than the text.
    const bool rounded = array.type == ScalarType::float16 || array.type == ScalarType::bfloat16;
    if (array.missing_fill && rounded) {
      float value = 0;
      decode_values(*array.fill, array.type, array.codecs.big_endian, {}, {&value, 1});
      array.missing_fill = StoredValue{static_cast<double>(value)};
    }
  }
  return array;
}

}  // namespace weir
