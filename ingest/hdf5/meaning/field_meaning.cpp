#include "ingest/hdf5/meaning/field_meaning.h"

#include <cstddef>
#include <utility>
#include <vector>

#include "format/base/text.h"
#include "ingest/axes/axis_details.h"
#include "ingest/hdf5/file/hdf5_attribute.h"
#include "ingest/hdf5/file/hdf5_object.h"
#include "ingest/hdf5/meaning/dimension_scales.h"
#include "ingest/hdf5/meaning/openpmd.h"

namespace weir {
namespace {

std::string text_of(hid_t object, const char* name) {
  const std::vector<std::string> texts = text_attribute(object, name);
  return texts.empty() ? "" : texts[0];
}

// The element of a time coordinate for position `at` of `extent`; a single one is for all.
std::optional<TimePoint> time_in(hid_t coordinate, std::size_t at, std::size_t extent) {
  const std::string units = text_of(coordinate, "units");
  if (H5Iget_type(coordinate) != H5I_DATASET || units.find(" since ") == std::string::npos) return std::nullopt;
  const std::vector<double> values = coordinate_values(coordinate);
  if (values.size() != 1 && values.size() != extent) return std::nullopt;
  return TimePoint{values[values.size() == 1 ? 0 : at], units, text_of(coordinate, "calendar")};
}

// CF 5: coordinates = "lon lat time" names variables of the same group, or of one around it.
std::optional<TimePoint> auxiliary_time(const Hdf5Object& object, std::span<const Hdf5Handle> groups, std::size_t at,
                                        std::size_t extent) {
  for (const std::string& name : split(text_of(object.handle.get(), "coordinates"), ' ')) {
    for (const Hdf5Handle& group : groups) {
      const Hdf5Handle coordinate = open_linked(group.get(), name);
      if (!coordinate) continue;
      if (auto time = time_in(coordinate.get(), at, extent)) return time;
    }
  }
  return std::nullopt;
}

std::optional<TimePoint> time_of(hid_t file, const Hdf5Object& object, std::span<const AxisPlace> axes,
                                 const VolumeSlice& slice) {
  std::size_t at = 0;
  std::size_t extent = 0;
  for (std::size_t i = 0; i < slice.index.size(); ++i) {
    const AxisPlace& axis = axes[slice.roles.others[i]];
    if (!axis.is_time) continue;
    at = static_cast<std::size_t>(slice.index[i]);
    extent = static_cast<std::size_t>(axis.extent);
    if (at < axis.coordinates.size()) return TimePoint{axis.coordinates[at], axis.units, axis.calendar};
  }
  const std::vector<Hdf5Handle> groups = enclosing_groups(file, object.name);
  if (auto time = auxiliary_time(object, groups, at, extent)) return time;
  if (const auto seconds = openpmd_time(groups)) return TimePoint{*seconds, "s", {}};
  return std::nullopt;
}

}  // namespace

FieldDetails field_details(hid_t file, const Hdf5Object& object, std::span<const AxisPlace> axes,
                           const VolumeSlice& slice) {
  FieldDetails details;
  details.long_name = long_name_of(object.handle.get());
  details.time = time_of(file, object, axes, slice);
  const auto& [z, y, x] = slice.roles.volume;
  describe_axes({&axes[x], &axes[y], &axes[z]}, details);
  return details;
}

std::string long_name_of(hid_t object) {
  std::string name = text_of(object, "long_name");
  return name.empty() ? text_of(object, "description") : name;
}

}  // namespace weir
