// Notes on what a file says about its values and weir does not apply.
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "format/base/scalar_type.h"
#include "ingest/source/stored_value.h"

namespace weir {

/// Attributes of NetCDF that say which values are valid. weir does not apply them.
inline constexpr std::array<const char*, 3> kValidAttributes{"valid_range", "valid_min", "valid_max"};

/// Returns the note that the attribute `name`, one of kValidAttributes, is not applied.
std::string not_applied_note(std::string_view name);

/// Returns the note that the attribute `name` declares `value` as "no data" although `type` cannot hold it. Returns
/// "" if it can.
std::string unheld_note(std::string_view name, const StoredValue& value, ScalarType type);

/// Adds `note` to `notes` unless it is empty.
void add_note(const std::string& note, std::string& notes);

}  // namespace weir
