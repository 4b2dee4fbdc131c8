#include "ingest/hdf5/meaning/openpmd.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>

#include "ingest/hdf5/file/hdf5_attribute.h"

namespace weir {
namespace {

// One value per axis, in the file's order; empty where there are not as many.
template <typename T>
std::vector<T> per_axis(std::vector<T> values, std::size_t axes, bool fastest_first) {
  if (values.size() != axes) return {};
  if (fastest_first) std::reverse(values.begin(), values.end());
  return values;
}

double first_or(const std::vector<double>& values, double fallback) { return values.empty() ? fallback : values[0]; }

}  // namespace

void place_by_openpmd(hid_t object, std::span<const Hdf5Handle> groups, std::span<AxisPlace> axes) {
  hid_t record = object;
  if (!has_attribute(record, "gridSpacing")) {
    if (groups.empty() || !has_attribute(groups[0].get(), "gridSpacing")) return;
    record = groups[0].get();
  }
  const std::vector<std::string> order = text_attribute(record, "dataOrder");
  const bool fastest_first = !order.empty() && order[0] == "F";
  const auto numbers = [&](hid_t of, const char* name) {
    return per_axis(number_attribute(of, name), axes.size(), fastest_first);
  };
  const auto labels = per_axis(text_attribute(record, "axisLabels"), axes.size(), fastest_first);
  const auto spacing = numbers(record, "gridSpacing");
  const auto offset = numbers(record, "gridGlobalOffset");
  const auto position = numbers(object, "position");
  const double metres = first_or(number_attribute(record, "gridUnitSI"), 1.0);
  for (std::size_t i = 0; i < axes.size(); ++i) {
    if (!labels.empty()) axes[i].label = labels[i];
    if (spacing.empty()) continue;
    axes[i].spacing = spacing[i] * metres;
    const double in_cell = position.empty() ? 0.0 : position[i];
    axes[i].origin = ((offset.empty() ? 0.0 : offset[i]) + in_cell * spacing[i]) * metres;
  }
}

std::optional<double> openpmd_unit_si(hid_t object) {
  const std::vector<double> unit = number_attribute(object, "unitSI");
  if (unit.size() != 1) return std::nullopt;
  return unit[0];
}

std::optional<double> openpmd_time(std::span<const Hdf5Handle> groups) {
  for (const Hdf5Handle& group : groups) {
    const std::vector<double> time = number_attribute(group.get(), "time");
    const std::vector<double> seconds = number_attribute(group.get(), "timeUnitSI");
    if (time.size() == 1 && seconds.size() == 1) return time[0] * seconds[0];
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
