// What is said of the three axes of a volume besides their places.
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

/// What is said of `axis`, a volume's x, y or z by `of_volume` (0, 1, 2): units, note, and coordinates that are not
/// equally spaced, up to a number that a sidecar has room for.
AxisDetails axis_details(const AxisPlace& axis, std::size_t of_volume);

/// Puts what is said of all of them into `details`: of each alone, and order and orientation.
void describe_axes(const VolumeAxes& axes, FieldDetails& details);

/// What is said of `axis`, a volume's x, y or z by `of_volume` (0, 1, 2), of which spacing and origin are not all: that
/// its coordinates are irregular, or that they fall. Empty where that is nothing.
std::string axis_note(const AxisPlace& axis, std::size_t of_volume);

/// "axis x (xh) is in km, y (yh) in km, z (zh) in m", where those that have a spacing have it in different units; else
/// empty.
std::string units_note(const VolumeAxes& axes);

/// "its axes are x, y, z, slowest first, and x is the fastest: the file's z lies along x, ...", where the names of at
/// least two are those of others among them; else empty.
std::string order_note(const VolumeAxes& axes);

/// Which of them points down and what that means, where CF's `positive` says it and spacing and origin do not; else
/// empty.
std::string down_note(const VolumeAxes& axes);

/// What a listing says of them, as names and values: notes, order, orientation, spacing, origin. Nothing of where they
/// are where one is a time.
std::vector<std::pair<std::string, std::string>> listed_axes(const VolumeAxes& axes);

}  // namespace weir
