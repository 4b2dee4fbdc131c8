// Arrays of vectors and tensors: the axis of their components.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "ingest/axes/axis_place.h"
#include "ingest/source/component_choice.h"

namespace weir {

/// The last axis of four or more, where it holds the components of each voxel; or the one before the last three.
struct ComponentAxis {
  std::int64_t count = 1;  ///< 1: there is none
  std::string evidence;    ///< how sure that is: "by its name vector", "by its extent alone"
  bool leading = false;    ///< before the last three axes: each component is a volume

  bool found() const { return count > 1; }
};

/// A last axis, by its name (component, vector, rgb ...). Else by its extent of 2, 3, 4 or 9, where it is neither a
/// time nor like an axis of space (space_axis.h): after an axis that is called like an x axis, or has coordinates while
/// the last has none; or by the extent alone, where the axis before is not shorter and three are left that are no time.
/// Never a leading one: its components are volumes as they are.
ComponentAxis component_axis(std::span<const AxisPlace> axes);

/// The same for a user who says that there is one. Also the axis before the last three, by its name; a last one of 2,
/// 3, 4 or 9 that is no axis of space, unless that before it is shorter; else one of the two of which the file says
/// nothing, of 2 to kMostComponents and shorter than the three beside it; else a last one of 2, 3, 4 or 9 whatever it
/// is. `leading_counts`: one before the last three may be it.
ComponentAxis asked_component_axis(std::span<const AxisPlace> axes, bool leading_counts = true);

/// The axis of `axes` that `component` chooses on: none without one, where `positions`, those of --index, make a volume
/// of the last three whatever they are. `leading_counts` as above. Throws Error(usage), beginning with `said`, "here:
/// its axes are 4 x 5 x 6 x 3", where a choice is needed, is of none, or does not fit.
ComponentAxis chosen_component_axis(std::span<const AxisPlace> axes, std::size_t positions, const std::string& said,
                                    const std::optional<ComponentChoice>& component, bool leading_counts = true);

}  // namespace weir
