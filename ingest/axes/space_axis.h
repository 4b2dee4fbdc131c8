// Recognises the axes of space by their names and coordinates.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "ingest/axes/axis_place.h"

namespace weir {

inline constexpr std::size_t kSpaceAxes = 3;  // x, y and z

/// Returns whether `label` names the fastest axis of space: x, lon, west_east, xh, ...
bool names_x_axis(const std::string& label);

/// Returns 0, 1 or 2 if `label` names the x, y or z of space (z: height or depth), and nullopt for other names.
std::optional<std::size_t> space_direction(const std::string& label);

/// Returns whether `label` names an axis of space, whichever it is: the names of space_direction(), j, k, eta, ...
bool names_space_axis(const std::string& label);

/// Returns whether CF's attribute `positive` of coordinates (CF 4.3) says that they increase downwards.
bool is_down(std::string_view positive);

/// Returns whether the file describes `axis` as only an axis of space can be: by its name (x, lat, level, depth,
/// south_north, ...), or by coordinates with units.
bool is_space_axis(const AxisPlace& axis);

}  // namespace weir
