#include "ingest/hdf5/meaning/vtk_hdf.h"

#include <array>
#include <cstddef>
#include <vector>

#include "ingest/hdf5/file/hdf5_attribute.h"
#include "ingest/values/axis_placement.h"

namespace weir {
namespace {

bool lies_in(const Hdf5Object& object, std::string_view group) {
  const std::string_view name = object.name;
  const std::string_view parent = name.substr(0, name.rfind('/'));
  return parent.substr(parent.rfind('/') + 1) == group;
}

}  // namespace

void place_by_vtk_hdf(const Hdf5Object& object, std::span<const Hdf5Handle> groups, std::span<AxisPlace> axes) {
  const bool cells = lies_in(object, "CellData");
  if (axes.size() < 3 || groups.size() < 2 || !(cells || lies_in(object, "PointData"))) return;
  const hid_t image = groups[1].get();
  const std::vector<double> extent = number_attribute(image, "WholeExtent");
  const std::vector<double> origin = number_attribute(image, "Origin");
  const std::vector<double> spacing = number_attribute(image, "Spacing");
  std::vector<double> direction = number_attribute(image, "Direction");
  if (extent.size() != 6 || origin.size() != 3 || spacing.size() != 3) return;
  if (direction.size() != 9) direction = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  std::array<Vector3, 3> steps{};
  Vector3 first{origin[0], origin[1], origin[2]};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t c = 0; c < 3; ++c) {
      steps[axis][c] = direction[3 * c + axis] * spacing[axis];
      first[c] += (extent[2 * axis] + (cells ? 0.5 : 0.0)) * steps[axis][c];
    }
  }
  const AxisPlacement placement = place_axes(steps, first);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    AxisPlace& place = axes[axes.size() - 1 - axis];
    if (!place.spacing) place.spacing = placement.spacing[axis];
    if (!place.origin) place.origin = placement.origin[axis];
    place.orientation = placement.orientation;
  }
}

}  // namespace weir
