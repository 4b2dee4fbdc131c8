// Which axes of an array are a volume's, and which need a position each.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "ingest/axes/axis_place.h"
#include "ingest/axes/component_axis.h"

namespace weir {

/// The axes of an array of three or more, by their places among them, 0 the slowest.
struct AxisRoles {
  std::array<std::size_t, 3> volume{};  ///< z, y, x
  std::vector<std::size_t> others;      ///< in the file's order

  /// Whether some of the others lie between the volume's axes, or behind them.
  bool interleaved() const { return !others.empty() && others.back() > volume[0]; }
};

/// The volume's are the last three that are no time; the last three whatever they are where fewer are none. `axes` are
/// those of an array, without one of components.
AxisRoles axis_roles(std::span<const AxisPlace> axes);

/// The same of all axes of an array, four or more where `components` are found; that of the components has neither
/// role.
AxisRoles axis_roles_beside(const ComponentAxis& components, std::span<const AxisPlace> axes);

}  // namespace weir
