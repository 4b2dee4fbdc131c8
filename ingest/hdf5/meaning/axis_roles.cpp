#include "ingest/hdf5/meaning/axis_roles.h"

#include <algorithm>

namespace weir {

AxisRoles axis_roles(std::span<const AxisPlace> axes) {
  AxisRoles roles;
  const auto of_space = std::count_if(axes.begin(), axes.end(), [](const AxisPlace& axis) { return !axis.is_time; });
  std::size_t left = roles.volume.size();
  for (std::size_t i = axes.size(); i-- > 0;) {
    const bool counts = of_space < static_cast<std::ptrdiff_t>(roles.volume.size()) || !axes[i].is_time;
    if (counts && left > 0) {
      roles.volume.at(--left) = i;
    } else {
      roles.others.push_back(i);
    }
  }
  std::reverse(roles.others.begin(), roles.others.end());
  return roles;
}

AxisRoles axis_roles_beside(const ComponentAxis& components, std::span<const AxisPlace> axes) {
  const bool behind = components.found() && !components.leading;
  AxisRoles roles = axis_roles(axes.first(axes.size() - (behind ? 1 : 0)));
  if (components.leading) roles.others.pop_back();
  return roles;
}

}  // namespace weir
