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

/// Larger documents are refused before they are read.
inline constexpr std::uint64_t kMostMetadataBytes = std::uint64_t{16} << 20U;

/// Of numbers, texts, lists and objects in a document: each takes some 100 bytes, up to 50 times what it has in the
/// file.
inline constexpr std::size_t kMostMetadataValues = 100000;

/// The JSON object that `text` holds, without its member consolidated_metadata: copies of what is in a group. NaN,
/// Infinity and -Infinity, which Python writes though JSON has none, are read as the texts "NaN", "Infinity" and
/// "-Infinity". Throws Error(input), beginning with `where`, where it is no JSON, with the byte, nested deeper than
/// metadata are, of more than kMostMetadataValues values, and where it is no object.
nlohmann::json parse_zarr_json(std::string_view text, const std::string& where);

/// How many values `value` is, itself among them.
std::size_t json_values(const nlohmann::json& value);

/// A value of a document as a message shows it: at most 60 characters.
std::string json_text(const nlohmann::json& value);

/// The member `key` of `object`; null where there is none or `object` is no object.
const nlohmann::json& json_member(const nlohmann::json& object, const char* key);

/// The text that the member `key` holds, empty where it is none.
std::string json_string(const nlohmann::json& object, const char* key);

/// The number that `value` is, or NaN where it is the text "NaN"; nullopt for anything else.
std::optional<StoredValue> json_number(const nlohmann::json& value);

/// The whole numbers of the list `value`, each from `least` on, which messages call `name`. Throws Error(input),
/// beginning with `where`, where it is no list of such.
std::vector<std::int64_t> json_extents(const nlohmann::json& value, const char* name, std::int64_t least,
                                       const std::string& where);

}  // namespace weir
