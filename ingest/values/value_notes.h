// What a file says of its values and weir makes nothing of, in words.
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "format/base/scalar_type.h"
#include "ingest/source/stored_value.h"

namespace weir {

/// Attributes of NetCDF that say which values are valid, and are not applied.
inline constexpr std::array<const char*, 3> kValidAttributes{"valid_range", "valid_min", "valid_max"};

/// That the attribute `name`, one of kValidAttributes, is not applied.
std::string not_applied_note(std::string_view name);

/// That the attribute `name` says that `value` stands for no data, which none of `type` is; empty where one may be.
std::string unheld_note(std::string_view name, const StoredValue& value, ScalarType type);

/// Adds `note`, where there is one, to `notes`.
void add_note(const std::string& note, std::string& notes);

}  // namespace weir
