// What the metadata of both versions of Zarr have in common.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "format/base/error.h"
#include "ingest/zarr/metadata/zarr_array.h"

namespace weir {

/// By its name in either version, "numcodecs." before it or not; nullopt for any other.
std::optional<ZarrPacker> parse_packer(std::string_view name);

/// "." or "/". Throws Error(input) for anything else, which messages call `name`.
char read_separator(const nlohmann::json& value, const char* name, const std::string& where);

/// Throws Error(input) where `chunk`, which messages call `name`, has not as many axes as `shape`.
void require_same_axes(const std::vector<std::int64_t>& shape, const std::vector<std::int64_t>& chunk, const char* name,
                       const std::string& where);

/// Of a list of as many texts, or nulls, as there are axes; anything else names none.
void read_axis_names(const nlohmann::json& names, ZarrArray& array);

/// "WHERE: its type is TYPE; a volume has ...".
Error unsupported_type(const std::string& where, std::string_view type);
/// Of a `role` ("codec", "compressor") that is not read here.
Error unsupported_codec(const std::string& where, std::string_view role, std::string_view name);

}  // namespace weir
