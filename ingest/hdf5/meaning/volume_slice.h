// Chooses the three axes of an array that make the volume, and the position on the other axes.
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

/// The last three axes of an array that are no time (axis_roles), x last, at one position on each other axis. If the
/// last axis holds components, the three axes are chosen from the axes before it.
struct VolumeSlice {
  Index3 extent;
  VoxelComponents components;
  bool planar = false;  ///< components are volumes one behind the other, along the axis before the three
  AxisRoles roles;
  std::vector<std::int64_t> index;      ///< one per other axis, slowest first
  std::vector<std::int64_t> positions;  ///< the same; and that of the component on an axis of them before the three
  std::array<std::string, 3> labels;
  std::array<double, 3> spacing{1.0, 1.0, 1.0};
  std::array<double, 3> origin{0.0, 0.0, 0.0};
  std::array<bool, 3> falls{};  ///< coordinates of x, y, z fall; read in reverse order, they rise
};

/// Returns how many positions --index must give: one for each axis outside the volume, or none if each of these axes
/// has one element only. An axis of components (component_axis) counts as neither.
std::size_t leading_axes(std::span<const AxisPlace> axes);

/// Returns the slice of `axes` (three or more, none of extent 0) at `index`, of `component`. Throws Error(usage),
/// beginning with `where` and listing the axes, if positions are missing, too many or outside, if an axis of
/// components needs a choice, or if a component is given and there are none. Positions for all axes but three,
/// without a component, make a volume of the last three axes that are no time, whatever else these axes are.
VolumeSlice volume_slice(std::span<const AxisPlace> axes, const std::vector<std::int64_t>& index,
                         const std::string& where, const std::optional<ComponentChoice>& component = {});

}  // namespace weir
