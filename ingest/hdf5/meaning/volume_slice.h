// The three axes of an array that make the volume, and the position on the
// others.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "format/base/index.h"
#include "ingest/hdf5/meaning/axis_places.h"
#include "ingest/hdf5/meaning/axis_roles.h"
#include "ingest/source/component_choice.h"

namespace weir {

inline constexpr std::size_t kVolumeRank = 3;

/// The last three axes of an array that are no time, x being the last, at one position on each other one (axis_roles);
/// or the same of the axes before one of components.
struct VolumeSlice {
  Index3 extent;
  VoxelComponents components;
  bool planar = false;  ///< these are volumes one behind the other, along the axis before the three
  AxisRoles roles;
  std::vector<std::int64_t> index;      ///< one per other axis, slowest first
  std::vector<std::int64_t> positions;  ///< the same; and that of the component on an axis of them before the three
  std::array<std::string, 3> labels;
  std::array<double, 3> spacing{1.0, 1.0, 1.0};
  std::array<double, 3> origin{0.0, 0.0, 0.0};
  std::array<bool, 3> falls{};  ///< coordinates of x, y, z: read in reverse order, they rise
};

/// How many positions --index must give: one per axis that is none of the volume's, or none where each has one element
/// only. An axis of components (component_axis) is none of either.
std::size_t leading_axes(std::span<const AxisPlace> axes);

/// The slice of `axes` (three or more, none of extent 0) at `index`, of `component`. Throws Error(usage), beginning
/// with `where` and saying the axes, where positions are missing, too many or outside; where an axis of components
/// needs a choice; where there are none to choose from. Positions for all axes but three, and no component, make a
/// volume of the last three that are no time, whatever else they are.
VolumeSlice volume_slice(std::span<const AxisPlace> axes, const std::vector<std::int64_t>& index,
                         const std::string& where, const std::optional<ComponentChoice>& component = {});

}  // namespace weir
