// Which names and coordinates an axis of space has.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "ingest/axes/axis_place.h"

namespace weir {

inline constexpr std::size_t kSpaceAxes = 3;  // x, y and z

/// Whether an axis called so is the fastest one of space: x, lon, west_east, xh, ...
bool names_x_axis(const std::string& label);

/// 0, 1 or 2 where an axis called so is the x, y or z of space (z: of height or depth); nullopt for other names.
std::optional<std::size_t> space_direction(const std::string& label);

/// Whether an axis called so is one of space, whichever it is: the names above, j, k, eta, ...
bool names_space_axis(const std::string& label);

/// Whether CF's attribute `positive` of coordinates (4.3) says that they rise downwards.
bool is_down(std::string_view positive);

/// Whether what the file says of `axis` is said of an axis of space only: its name (x, lat, level, depth, south_north,
/// ...), or coordinates with units.
bool is_space_axis(const AxisPlace& axis);

}  // namespace weir
