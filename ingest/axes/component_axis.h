// Finds the axis of components in arrays of vectors and tensors.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "ingest/axes/axis_place.h"
#include "ingest/source/component_choice.h"

namespace weir {

/// The component axis of an array of four or more axes: the last axis, or the axis before the last three.
struct ComponentAxis {
  std::int64_t count = 1;  ///< 1 if there is no component axis
  std::string evidence;    ///< why this axis is the component axis: "by its name vector", "by its extent alone"
  bool leading = false;    ///< the component axis is before the last three axes: each component is a volume

  bool found() const { return count > 1; }
};

/// Returns the last axis if its name says components (component, vector, rgb ...). Otherwise returns the last axis if
/// its extent is 2, 3, 4 or 9, it is neither a time nor like an axis of space (space_axis.h), and one of two
/// conditions holds. One: the axis before it has the name of an x axis, or has coordinates while the last has none.
/// Two: the axis before it is not shorter, and three axes that are no time remain. Never returns a leading axis,
/// because its components already are volumes.
ComponentAxis component_axis(std::span<const AxisPlace> axes);

/// Returns whether the last axis that is no time has the name of components, and times are behind it.
bool components_before_time(std::span<const AxisPlace> axes);

/// Returns the component axis if the user says that there is one. Tries, after component_axis(): the axis before the
/// last three, by its name; a last axis of 2, 3, 4 or 9 that is no axis of space, unless the axis before it is
/// shorter; the last axis, then the axis before the last three, if the file says nothing about it, it has 2 to
/// kMostComponents elements and it is shorter than the three beside it; finally any last axis of 2, 3, 4 or 9.
/// `leading_counts` says whether the axis before the last three may be the component axis.
ComponentAxis asked_component_axis(std::span<const AxisPlace> axes, bool leading_counts = true);

/// Returns the axis of `axes` that `component` chooses on. Without `component`, returns none if `positions`, the
/// number of positions in --index, make the last three axes a volume. `leading_counts` is as for
/// asked_component_axis(). Throws Error(usage), beginning with `said` ("here: its axes are 4 x 5 x 6 x 3"), if a
/// choice is needed, has no axis, or does not fit.
ComponentAxis chosen_component_axis(std::span<const AxisPlace> axes, std::size_t positions, const std::string& said,
                                    const std::optional<ComponentChoice>& component, bool leading_counts = true);

}  // namespace weir
