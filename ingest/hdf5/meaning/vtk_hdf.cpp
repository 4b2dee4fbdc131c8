#include "ingest/hdf5/meaning/vtk_hdf.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "ingest/axes/coordinates.h"
#include "ingest/hdf5/file/hdf5_attribute.h"
#include "ingest/hdf5/meaning/dimension_scales.h"
#include "ingest/values/axis_placement.h"
#include "ingest/vtk/vtk_marks.h"

namespace weir {
namespace {

constexpr std::string_view kPoints = "PointData";
constexpr std::string_view kCells = "CellData";
constexpr const char* kStepTimes = "Steps/Values";

bool lies_in(const Hdf5Object& object, std::string_view group) {
  const std::string_view name = object.name;
  const std::string_view parent = name.substr(0, name.rfind('/'));
  return parent.substr(parent.rfind('/') + 1) == group;
}

// Returns the group of the image that has `object` as an array of points or cells; invalid if there is none.
hid_t image_of(const Hdf5Object& object, std::span<const Hdf5Handle> groups) {
  const bool of_image = groups.size() >= 2 && (lies_in(object, kCells) || lies_in(object, kPoints)) &&
                        has_attribute(groups[1].get(), "WholeExtent");
  return of_image ? groups[1].get() : H5I_INVALID_HID;
}

std::vector<double> finite_numbers(hid_t image, const std::string& name) {
  const Hdf5Handle dataset = open_linked(image, name);
  if (!dataset || !is_dataset(dataset.get())) return {};
  std::vector<double> values = coordinate_values(dataset.get());
  const bool finite = std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
  return finite ? values : std::vector<double>();
}

// Returns the times of the elements along an array's slowest axis; empty if some elements have no time.
std::vector<double> times_of_elements(const Hdf5Object& object, hid_t image, std::size_t elements) {
  const std::vector<double> times = finite_numbers(image, kStepTimes);
  const std::string array = object.name.substr(object.name.rfind('/') + 1);
  const char* const group = lies_in(object, kCells) ? "Steps/CellDataOffsets/" : "Steps/PointDataOffsets/";
  const std::vector<double> offsets = finite_numbers(image, group + array);
  if (offsets.size() != times.size()) return times.size() == elements ? times : std::vector<double>();
  std::vector<double> of_elements(elements, std::nan(""));
  for (std::size_t step = times.size(); step-- > 0;) {  // the first step of those that share an element
    if (offsets[step] < 0 || offsets[step] >= static_cast<double>(elements)) continue;
    of_elements[static_cast<std::size_t>(offsets[step])] = times[step];
  }
  const bool all = std::none_of(of_elements.begin(), of_elements.end(), [](double time) { return std::isnan(time); });
  return all ? of_elements : std::vector<double>();
}

void place_in_time(const Hdf5Object& object, hid_t image, AxisPlace& axis) {
  if (axis.is_time || axis.extent < 1 || !open_linked(image, kStepTimes)) return;
  axis.is_time = true;
  if (axis.label.empty()) axis.label = "time";
  if (std::cmp_less_equal(axis.extent, kMaxCoordinates)) {
    axis.coordinates = times_of_elements(object, image, static_cast<std::size_t>(axis.extent));
  }
}

}  // namespace

void place_by_vtk_hdf(const Hdf5Object& object, std::span<const Hdf5Handle> groups, std::span<AxisPlace> axes) {
  const hid_t image = image_of(object, groups);
  if (axes.size() < 3 || image == H5I_INVALID_HID) return;
  const bool cells = lies_in(object, kCells);
  if (axes.size() == 4) place_in_time(object, image, axes[0]);
  const std::vector<double> extent = number_attribute(image, "WholeExtent");
  const std::vector<double> origin = number_attribute(image, "Origin");
  const std::vector<double> spacing = number_attribute(image, "Spacing");
  std::vector<double> direction = number_attribute(image, "Direction");
  if (extent.size() != 6 || origin.size() != 3 || spacing.size() != 3) return;
  if (direction.size() != 9) direction = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  std::array<Vector3, 3> steps{};
  Vector3 first{origin[0], origin[1], origin[2]};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    // The cells of a flat image lie in its plane.
    const double middle = cells && extent[2 * axis + 1] > extent[2 * axis] ? 0.5 : 0.0;
    for (std::size_t c = 0; c < 3; ++c) {
      steps[axis][c] = direction[3 * c + axis] * spacing[axis];
      first[c] += (extent[2 * axis] + middle) * steps[axis][c];
    }
  }
  const AxisPlacement placement = place_axes(steps, first);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    AxisPlace& place = axes[axes.size() - 1 - axis];
    if (!place.spacing) {
      place.spacing = placement.spacing[axis];
      place.spacing_from = "attribute Spacing of its image";
    }
    if (!place.origin) {
      place.origin = placement.origin[axis];
      place.origin_from = "attribute Origin of its image";
    }
    place.orientation = placement.orientation;
  }
}

TimeValues vtk_hdf_time(const Hdf5Object& object, std::span<const Hdf5Handle> groups) {
  const hid_t image = image_of(object, groups);
  if (image == H5I_INVALID_HID) return {};
  std::vector<double> times = finite_numbers(image, kStepTimes);
  if (times.empty()) times = finite_numbers(image, "FieldData/TimeValue");
  return {std::move(times), {}, {}};
}

bool is_vtk_hdf_mark(const Hdf5Object& object, std::span<const Hdf5Handle> groups) {
  return marks_places(object.name.substr(object.name.rfind('/') + 1)) && image_of(object, groups) != H5I_INVALID_HID;
}

}  // namespace weir
