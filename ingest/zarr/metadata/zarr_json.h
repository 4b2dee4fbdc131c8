// Metadata documents of Zarr: zarr.json, .zarray, .zattrs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "ingest/source/stored_value.h"

namespace weir {

/// The most bytes of a metadata document. Larger documents are refused before they are read.
inline constexpr std::uint64_t kMostMetadataBytes = std::uint64_t{16} << 20U;

/// The most values (numbers, texts, lists and objects) of a document. Each value takes some 100 bytes of memory, up
/// to 50 times its size in the file.
inline constexpr std::size_t kMostMetadataValues = 100000;

/// Returns the JSON object in `text`, without its member consolidated_metadata, which only copies the metadata inside
/// a group. NaN, Infinity and -Infinity, which Python writes although JSON does not have them, become the texts
/// "NaN", "Infinity" and "-Infinity". Throws Error(input), beginning with `where`, if `text` is not JSON (the message
/// names the byte) or not an object, is nested too deeply, or has more than kMostMetadataValues values.
nlohmann::json parse_zarr_json(std::string_view text, const std::string& where);

/// Returns the number of values in `value`, including `value` itself.
std::size_t json_values(const nlohmann::json& value);

/// Returns `value` as text for a message: about 60 characters at most.
std::string json_text(const nlohmann::json& value);

/// Returns the member `key` of `object`; null if there is no such member or `object` is not an object.
const nlohmann::json& json_member(const nlohmann::json& object, const char* key);

/// Returns the text of the member `key`; empty if the member is not a text.
std::string json_string(const nlohmann::json& object, const char* key);

/// Returns `value` as a number, NaN if it is the text "NaN", and nullopt for anything else.
std::optional<StoredValue> json_number(const nlohmann::json& value);

/// Returns the whole numbers of the list `value`, each >= `least`. Messages call the list `name`. Throws
/// Error(input), beginning with `where`, if `value` is not a list of such numbers or has too many of them.
std::vector<std::int64_t> json_extents(const nlohmann::json& value, const char* name, std::int64_t least,
                                       const std::string& where);

}  // namespace weir
