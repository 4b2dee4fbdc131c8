#include "ingest/hdf5/meaning/field_meaning.h"

#include <cstddef>
#include <vector>

#include "ingest/axes/axis_details.h"
#include "ingest/axes/volume_time.h"
#include "ingest/hdf5/file/hdf5_attribute.h"
#include "ingest/hdf5/file/hdf5_object.h"
#include "ingest/hdf5/meaning/auxiliary_times.h"
#include "ingest/hdf5/meaning/openpmd.h"
#include "ingest/hdf5/meaning/vtk_hdf.h"

namespace weir {
namespace {

std::optional<TimePoint> auxiliary_time(const Hdf5Object& object, std::span<const Hdf5Handle> groups,
                                        const TimePosition& position) {
  for (const TimeValues& times : auxiliary_times(object, groups)) {
    if (auto time = position.in(times)) return time;
  }
  return std::nullopt;
}

std::optional<TimePoint> time_of(hid_t file, const Hdf5Object& object, std::span<const AxisPlace> axes,
                                 const VolumeSlice& slice) {
  std::vector<const AxisPlace*> leading;
  for (const std::size_t axis : slice.roles.others) leading.push_back(&axes[axis]);
  const TimePosition position = time_position(leading, slice.index);
  if (position.coordinate) return position.coordinate;
  const std::vector<Hdf5Handle> groups = enclosing_groups(file, object.name);
  if (auto time = auxiliary_time(object, groups, position)) return time;
  if (position.extent == 0) {  // elements of an axis of time have their own, or none
    if (auto time = position.in(vtk_hdf_time(object, groups))) return time;
  }
  if (const auto seconds = openpmd_time(object.handle.get(), groups)) return TimePoint{*seconds, "s", {}};
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
  std::string name = first_text_attribute(object, "long_name");
  return name.empty() ? first_text_attribute(object, "description") : name;
}

}  // namespace weir
