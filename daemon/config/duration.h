// Reads durations as the configuration file has them.
#pragma once

#include <optional>
#include <string_view>

namespace weir {

/// Returns the seconds of "90s", "10min", "2h", "3d" or "90", with or without a fraction; nullopt if the text is no
/// duration.
std::optional<double> parse_duration_s(std::string_view text);

}  // namespace weir
