// The details of a volume's three axes besides their places: units, notes, order and orientation.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "ingest/axes/axis_place.h"
#include "ingest/source/field_details.h"

namespace weir {

using VolumeAxes = std::array<const AxisPlace*, 3>;  ///< x, y, z

/// Returns the units and note of `axis`, which is the volume's x, y or z by `of_volume` (0, 1, 2), and its
/// coordinates if they are not equally spaced and few enough for a sidecar.
AxisDetails axis_details(const AxisPlace& axis, std::size_t of_volume);

/// Writes the details of all axes into `details`: those of each axis, and the order, orientation and units of all.
void describe_axes(const VolumeAxes& axes, FieldDetails& details);

/// Returns what spacing and origin do not say about `axis`, which is the volume's x, y or z by `of_volume` (0, 1, 2):
/// its coordinates are irregular, or they fall. Otherwise returns "".
std::string axis_note(const AxisPlace& axis, std::size_t of_volume);

/// Returns "axis x (xh) is in km, y (yh) in km, z (zh) in m" if the axes with a spacing have different units,
/// otherwise "".
std::string units_note(const VolumeAxes& axes);

/// Returns "its axes are x, y, z, slowest first, and x is the fastest: the file's z lies along x, ..." if at least
/// two axes have the name of another direction, otherwise "".
std::string order_note(const VolumeAxes& axes);

/// Returns which axis points down and what this means, if CF's `positive` says so; spacing and origin do not say it.
/// Otherwise returns "".
std::string down_note(const VolumeAxes& axes);

/// Returns what a listing says about the axes, as names and values: notes, order, orientation, spacing, origin.
/// Returns nothing if one of them is a time.
std::vector<std::pair<std::string, std::string>> listed_axes(const VolumeAxes& axes);

}  // namespace weir
