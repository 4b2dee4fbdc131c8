// Durations as a configuration writes them.
#pragma once

#include <optional>
#include <string_view>

namespace weir {

/// Seconds of "90s", "10min", "2h", "3d" or "90", with a fraction or without; nullopt where the text is no duration.
std::optional<double> parse_duration_s(std::string_view text);

}  // namespace weir
