// Decides which axes of an array make the volume, and which need one position each.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "ingest/axes/axis_place.h"
#include "ingest/axes/component_axis.h"

namespace weir {

/// The axes of an array with three or more axes, by axis number, 0 the slowest.
struct AxisRoles {
  std::array<std::size_t, 3> volume{};  ///< z, y, x
  std::vector<std::size_t> others;      ///< in the file's order

  /// Returns whether some of `others` lie between the volume's axes or after them.
  bool interleaved() const { return !others.empty() && others.back() > volume[0]; }
};

/// Returns the roles: the volume has the last three axes that are no time. If fewer than three are no time, it has
/// the last three axes of any kind. `axes` do not include an axis of components.
AxisRoles axis_roles(std::span<const AxisPlace> axes);

/// Returns the roles as axis_roles() does, for all axes of an array: four or more if `components` are found. The axis
/// of components gets neither role.
AxisRoles axis_roles_beside(const ComponentAxis& components, std::span<const AxisPlace> axes);

}  // namespace weir
