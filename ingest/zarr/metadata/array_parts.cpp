#include "ingest/zarr/metadata/array_parts.h"

#include "format/base/text.h"
#include "ingest/headers/header_text.h"
#include "ingest/zarr/metadata/zarr_json.h"

namespace weir {

std::optional<ZarrPacker> parse_packer(std::string_view name) {
  constexpr std::string_view kNumcodecs = "numcodecs.";
  if (name.starts_with(kNumcodecs)) name.remove_prefix(kNumcodecs.size());
  for (const ZarrPacker packer :
       {ZarrPacker::zlib, ZarrPacker::gzip, ZarrPacker::zstd, ZarrPacker::blosc, ZarrPacker::crc32c}) {
    if (name == packer_name(packer)) return packer;
  }
  return std::nullopt;
}

char read_separator(const nlohmann::json& value, const char* name, const std::string& where) {
  if (value == ".") return '.';
  if (value == "/") return '/';
  throw input_error(where, cat(name, " is ", json_text(value), ", and must be \".\" or \"/\"; the file is damaged"));
}

void require_same_axes(const std::vector<std::int64_t>& shape, const std::vector<std::int64_t>& chunk, const char* name,
                       const std::string& where) {
  if (shape.size() == chunk.size()) return;
  throw input_error(where,
                    cat(name, " has ", chunk.size(), " axes, and shape has ", shape.size(), "; the file is damaged"));
}

void read_axis_names(const nlohmann::json& names, ZarrArray& array) {
  array.axis_names.assign(array.shape.size(), {});
  if (!names.is_array() || names.size() != array.shape.size()) return;
  for (std::size_t axis = 0; axis < names.size(); ++axis) {
    if (names[axis].is_string()) array.axis_names[axis] = names[axis].get<std::string>();
  }
}

Error unsupported_type(const std::string& where, std::string_view type) {
  return input_error(where,
                     cat("its type is ", type, "; a volume has integers of 8 to 64 bits or floats of 16, 32 or 64"));
}

Error unsupported_codec(const std::string& where, std::string_view role, std::string_view name) {
  return input_error(where,
                     cat("has the ", role, ' ', in_quotes(name),
                         ", and weir reads zlib, gzip, zstd, blosc and crc32c; write the array with one of them"));
}

}  // namespace weir
