#include "ingest/axes/axis_details.h"

#include <algorithm>
#include <set>

#include "format/base/text.h"
#include "ingest/axes/space_axis.h"

namespace weir {
namespace {

/// The most coordinates of an irregular axis that are kept: more would make the sidecar larger than a small volume.
constexpr std::size_t kMostKeptCoordinates = 16384;

// Returns the unit of the axis. degrees_north and degrees_east are the same unit.
std::string unit_of(const AxisPlace& axis) { return axis.units.starts_with("degree") ? "degrees" : axis.units; }

}  // namespace

AxisDetails axis_details(const AxisPlace& axis, std::size_t of_volume) {
  AxisDetails details;
  details.units = axis.units;
  details.reversed = axis.falls;
  details.note = axis_note(axis, of_volume);
  const bool irregular = !axis.note.empty() && !axis.falls;
  if (irregular && axis.coordinates.size() <= kMostKeptCoordinates) details.coordinates = axis.coordinates;
  return details;
}

void describe_axes(const VolumeAxes& axes, FieldDetails& details) {
  for (std::size_t i = 0; i < axes.size(); ++i) details.axes.at(i) = axis_details(*axes.at(i), i);
  details.orientation = axes[0]->orientation;
  if (details.orientation.empty()) {
    details.orientation = down_note(axes);
    details.points_down = !details.orientation.empty();
  }
  details.order_note = order_note(axes);
  details.units_note = units_note(axes);
}

std::string axis_note(const AxisPlace& axis, std::size_t of_volume) {
  if (!axis.falls) return axis.note;
  constexpr std::array<const char*, 3> kElements{"columns", "rows", "planes"};
  return cat(axis.note, ": ", kElements.at(of_volume), " are read in reverse order, so that positions rise");
}

std::string units_note(const VolumeAxes& axes) {
  std::string text;
  std::set<std::string> units;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const AxisPlace& axis = *axes.at(i);
    if (!axis.spacing || axis.units.empty()) continue;  // a place without units
    units.insert(unit_of(axis));
    text += cat(text.empty() ? "axis " : ", ", "xyz"[i], axis.label.empty() ? "" : " (", axis.label,
                axis.label.empty() ? "" : ")", text.empty() ? " is in " : " in ", axis.units);
  }
  return units.size() > 1 ? text : "";
}

std::string order_note(const VolumeAxes& axes) {
  std::string text;
  std::size_t others = 0;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const auto named = space_direction(axes.at(i)->label);
    if (!named || *named == i) continue;
    ++others;
    text += cat(text.empty() ? "" : ", ", axes.at(i)->label, " lies along ", "xyz"[i]);
  }
  if (others < 2) return "";
  return cat("its axes are ", axes[2]->label, ", ", axes[1]->label, ", ", axes[0]->label,
             ", slowest first, and x is the fastest: the file's ", text);
}

std::string down_note(const VolumeAxes& axes) {
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const AxisPlace& axis = *axes.at(i);
    if (!axis.points_down) continue;
    return cat("axis ", "xyz"[i], axis.label.empty() ? "" : " (", axis.label, axis.label.empty() ? "" : ")",
               " points down (positive = \"down\"): voxels lie where the file says, upside down where ", "xyz"[i],
               " is up; to turn them round, negate these coordinates in the file, or reverse the axis where they are "
               "irregular");
  }
  return "";
}

std::vector<std::pair<std::string, std::string>> listed_axes(const VolumeAxes& axes) {
  std::vector<std::pair<std::string, std::string>> listed;
  if (std::any_of(axes.begin(), axes.end(), [](const AxisPlace* axis) { return axis->is_time; })) return listed;
  const auto add = [&](std::string name, const std::string& value, const char* expected) {
    if (value != expected) listed.emplace_back(std::move(name), value);
  };
  std::string spacing;
  std::string origin;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const AxisPlace& axis = *axes.at(i);
    const char* const comma = i == 0 ? "" : ",";
    spacing += cat(comma, axis.spacing.value_or(1.0));
    origin += cat(comma, axis.origin.value_or(0.0));
    add(cat("axis ", std::string(1, "xyz"[i])), axis_note(axis, i), "");
  }
  add("order", order_note(axes), "");
  add("orientation", down_note(axes), "");
  add("spacing x,y,z", spacing, "1,1,1");
  add("origin x,y,z", origin, "0,0,0");
  return listed;
}

}  // namespace weir
