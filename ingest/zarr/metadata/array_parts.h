// Readers for the parts of the metadata that both versions of Zarr have in common.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "format/base/error.h"
#include "ingest/zarr/metadata/zarr_array.h"

namespace weir {

/// Returns the packer with this name in either version, with or without "numcodecs." before it; nullopt for any other
/// name.
std::optional<ZarrPacker> parse_packer(std::string_view name);

/// Returns '.' or '/'. Throws Error(input) for any other `value`, which messages call `name`.
char read_separator(const nlohmann::json& value, const char* name, const std::string& where);

/// Throws Error(input) if `chunk`, which messages call `name`, does not have as many axes as `shape`.
void require_same_axes(const std::vector<std::int64_t>& shape, const std::vector<std::int64_t>& chunk, const char* name,
                       const std::string& where);

/// Sets array.axis_names from `names`, a list of one text or null for each axis. Anything else leaves the axes
/// without names.
void read_axis_names(const nlohmann::json& names, ZarrArray& array);

/// Returns the error "WHERE: its type is TYPE; a volume has ...".
Error unsupported_type(const std::string& where, std::string_view type);
/// Returns the error for a codec `name` that is not supported; `role` is "codec" or "compressor".
Error unsupported_codec(const std::string& where, std::string_view role, std::string_view name);

}  // namespace weir
