#include "ingest/hdf5/meaning/auxiliary_times.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <string>
#include <utility>

#include "format/base/text.h"
#include "ingest/hdf5/file/hdf5_attribute.h"
#include "ingest/hdf5/meaning/dimension_scales.h"

namespace weir {
namespace {

// Returns the times of `coordinate`; empty if it is no time.
TimeValues times_of(hid_t coordinate) {
  check_attribute_bytes(coordinate);
  const std::string units = first_text_attribute(coordinate, "units");
  if (H5Iget_type(coordinate) != H5I_DATASET || units.find(" since ") == std::string::npos) return {};
  return {coordinate_values(coordinate), units, first_text_attribute(coordinate, "calendar")};
}

// Calls visit(coordinate, times) for each coordinate that is a time.
template <typename Visit>
void for_each_time(const Hdf5Object& object, std::span<const Hdf5Handle> groups, const Visit& visit) {
  for (const std::string& name : split(first_text_attribute(object.handle.get(), "coordinates"), ' ')) {
    for (const Hdf5Handle& group : groups) {
      const Hdf5Handle coordinate = open_linked(group.get(), name);
      if (!coordinate) continue;
      TimeValues times = times_of(coordinate.get());
      if (!times.values.empty()) visit(coordinate.get(), std::move(times));
    }
  }
}

// Returns the name of the dimension of a coordinate that is a row of numbers.
std::string dimension_of(hid_t coordinate, std::size_t count) {
  std::array<AxisPlace, 1> axis;
  axis[0].extent = static_cast<std::int64_t>(count);
  place_by_scales(coordinate, axis);
  return axis[0].label;
}

}  // namespace

std::vector<TimeValues> auxiliary_times(const Hdf5Object& object, std::span<const Hdf5Handle> groups) {
  std::vector<TimeValues> all;
  for_each_time(object, groups, [&](hid_t, TimeValues times) { all.push_back(std::move(times)); });
  return all;
}

void count_unwritten_times(const Hdf5Object& object, std::span<const Hdf5Handle> groups, std::span<AxisPlace> axes) {
  const auto wanted = std::find_if(axes.begin(), axes.end(), [](const AxisPlace& axis) {
    return axis.is_time && axis.grows && !axis.has_coordinates && axis.extent > 0;
  });
  if (wanted == axes.end()) return;
  for_each_time(object, groups, [&](hid_t coordinate, const TimeValues& times) {
    const std::int64_t more = std::ssize(times.values) - wanted->extent;
    if (more <= wanted->unwritten || dimension_of(coordinate, times.values.size()) != wanted->label) return;
    wanted->unwritten = more;
  });
}

}  // namespace weir
