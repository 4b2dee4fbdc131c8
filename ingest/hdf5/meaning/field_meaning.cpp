#include "ingest/hdf5/meaning/field_meaning.h"

#include <array>
#include <cstddef>
#include <set>
#include <utility>
#include <vector>

#include "format/base/text.h"
#include "ingest/hdf5/file/hdf5_attribute.h"
#include "ingest/hdf5/file/hdf5_object.h"
#include "ingest/hdf5/meaning/dimension_scales.h"
#include "ingest/hdf5/meaning/openpmd.h"
#include "ingest/hdf5/meaning/space_axis.h"

namespace weir {
namespace {

/// More coordinates of an irregular axis would make the sidecar larger than a small volume.
constexpr std::size_t kMostKeptCoordinates = 16384;

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
  for (std::size_t i = 0; i < kVolumeRank; ++i) {
    const AxisPlace& axis = axes[slice.roles.volume.at(kVolumeRank - 1 - i)];
    AxisDetails& kept = details.axes.at(i);
    kept.units = axis.units;
    kept.reversed = axis.falls;
    kept.note = axis_note(axis, i);
    const bool irregular = !axis.note.empty() && !axis.falls;
    if (irregular && axis.coordinates.size() <= kMostKeptCoordinates) kept.coordinates = axis.coordinates;
  }
  const auto& [z, y, x] = slice.roles.volume;
  details.orientation = axes[x].orientation;
  details.order_note = order_note(std::array{&axes[x], &axes[y], &axes[z]});
  details.units_note = units_note(std::array{&axes[x], &axes[y], &axes[z]});
  return details;
}

namespace {

// degrees_north and degrees_east are one unit.
std::string unit_of(const AxisPlace& axis) { return axis.units.starts_with("degree") ? "degrees" : axis.units; }

}  // namespace

std::string units_note(std::span<const AxisPlace* const, 3> axes) {
  std::string text;
  std::set<std::string> units;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const AxisPlace& axis = *axes[i];
    if (!axis.spacing || axis.units.empty()) continue;  // a place in no units
    units.insert(unit_of(axis));
    text += cat(text.empty() ? "axis " : ", ", "xyz"[i], axis.label.empty() ? "" : " (", axis.label,
                axis.label.empty() ? "" : ")", text.empty() ? " is in " : " in ", axis.units);
  }
  return units.size() > 1 ? text : "";
}

std::string order_note(std::span<const AxisPlace* const, 3> axes) {
  std::string text;
  std::size_t others = 0;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const auto named = space_direction(axes[i]->label);
    if (!named || *named == i) continue;
    ++others;
    text += cat(text.empty() ? "" : ", ", axes[i]->label, " lies along ", "xyz"[i]);
  }
  if (others < 2) return "";
  return cat("its axes are ", axes[2]->label, ", ", axes[1]->label, ", ", axes[0]->label,
             ", slowest first, and x is the fastest: the file's ", text);
}

std::string axis_note(const AxisPlace& axis, std::size_t of_volume) {
  if (!axis.falls) return axis.note;
  constexpr std::array<const char*, kVolumeRank> kElements{"columns", "rows", "planes"};
  return cat(axis.note, ": ", kElements.at(of_volume), " are read in reverse order, so that positions rise");
}

std::string long_name_of(hid_t object) {
  std::string name = text_of(object, "long_name");
  return name.empty() ? text_of(object, "description") : name;
}

}  // namespace weir
