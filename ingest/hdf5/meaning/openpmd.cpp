#include "ingest/hdf5/meaning/openpmd.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>

#include "format/base/ascii.h"
#include "format/base/text.h"
#include "ingest/hdf5/file/hdf5_attribute.h"

namespace weir {
namespace {

// Returns one value per axis, in the file's order; empty if the number of values differs.
template <typename T>
std::vector<T> per_axis(std::vector<T> values, std::size_t axes, bool fastest_first) {
  if (values.size() != axes) return {};
  if (fastest_first) std::reverse(values.begin(), values.end());
  return values;
}

// Returns the record of a mesh: `object`, or the group around it; invalid if neither is a record.
hid_t mesh_record(hid_t object, std::span<const Hdf5Handle> groups) {
  if (has_attribute(object, "gridSpacing")) return object;
  return !groups.empty() && has_attribute(groups[0].get(), "gridSpacing") ? groups[0].get() : H5I_INVALID_HID;
}

// Returns the time from the iteration to the record (`object` or the group around it). Staggered meshes have such
// offsets.
double time_offset(hid_t object, std::span<const Hdf5Handle> groups) {
  std::vector<double> offset = number_attribute(object, "timeOffset");
  if (offset.empty() && !groups.empty()) offset = number_attribute(groups[0].get(), "timeOffset");
  return offset.size() == 1 && std::isfinite(offset[0]) ? offset[0] : 0;
}

}  // namespace

void place_by_openpmd(hid_t object, std::span<const Hdf5Handle> groups, std::span<AxisPlace> axes) {
  const hid_t record = mesh_record(object, groups);
  if (record == H5I_INVALID_HID) return;
  const bool fastest_first = first_text_attribute(record, "dataOrder") == "F";
  const auto numbers = [&](hid_t of, const char* name) {
    return per_axis(number_attribute(of, name), axes.size(), fastest_first);
  };
  const auto labels = per_axis(text_attribute(record, "axisLabels"), axes.size(), fastest_first);
  const auto spacing = numbers(record, "gridSpacing");
  const auto offset = numbers(record, "gridGlobalOffset");
  const auto position = numbers(object, "position");
  // openPMD 1 has one unit, openPMD 2 has one unit for each axis.
  std::vector<double> metres = number_attribute(record, "gridUnitSI");
  if (metres.size() <= 1) metres.assign(axes.size(), metres.empty() ? 1.0 : metres[0]);
  metres = per_axis(std::move(metres), axes.size(), fastest_first);
  for (std::size_t i = 0; i < axes.size(); ++i) {
    if (!labels.empty()) axes[i].label = labels[i];
    if (spacing.empty() || metres.empty()) {
      axes[i].note = cat("its mesh's ", spacing.empty() ? "gridSpacing" : "gridUnitSI", " is not one for each of ",
                         axes.size(), " axes, taken as indices");
      continue;
    }
    axes[i].spacing = spacing[i] * metres[i];
    axes[i].spacing_from = "attribute gridSpacing";
    axes[i].origin_from = "attribute gridGlobalOffset";
    const double in_cell = position.empty() ? 0.0 : position[i];
    axes[i].origin = ((offset.empty() ? 0.0 : offset[i]) + in_cell * spacing[i]) * metres[i];
  }
}

std::string openpmd_obstacle(hid_t object, std::span<const Hdf5Handle> groups) {
  const hid_t record = mesh_record(object, groups);
  if (record == H5I_INVALID_HID) return {};
  const std::vector<std::string> geometry = text_attribute(record, "geometry");
  if (geometry.empty() || lower_case(geometry[0]) == "cartesian") return {};
  return cat("its geometry is ", geometry[0],
             " (openPMD), and a volume's axes are Cartesian; sample it on a Cartesian mesh first");
}

std::optional<double> openpmd_unit_si(hid_t object) {
  const std::vector<double> unit = number_attribute(object, "unitSI");
  if (unit.size() != 1) return std::nullopt;
  return unit[0];
}

std::optional<double> openpmd_time(hid_t object, std::span<const Hdf5Handle> groups) {
  for (const Hdf5Handle& group : groups) {
    const std::vector<double> time = number_attribute(group.get(), "time");
    const std::vector<double> seconds = number_attribute(group.get(), "timeUnitSI");
    if (time.size() == 1 && seconds.size() == 1) return (time[0] + time_offset(object, groups)) * seconds[0];
  }
  return std::nullopt;
}

std::vector<std::int64_t> openpmd_shape(hid_t object) {
  std::vector<std::int64_t> shape;
  for (const StoredValue& value : stored_value_attribute(object, "shape")) {
    if (!holds(ScalarType::int64, value)) return {};
    shape.push_back(std::visit([](const auto v) { return static_cast<std::int64_t>(v); }, value));
  }
  return shape;
}

}  // namespace weir
