#include "ingest/raw/stack_placement.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string_view>
#include <utility>

#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/axes/axis_details.h"
#include "ingest/axes/coordinates.h"

namespace weir {
namespace {

constexpr double kPlanePrecision = std::numeric_limits<float>::epsilon();  // headers round positions to a few digits

bool nearly(double a, double b, double spacing) {
  return std::fabs(a - b) <=
         kRegularTolerance * std::fabs(spacing) + kPlanePrecision * std::max(std::fabs(a), std::fabs(b));
}

// Returns the positions of all planes, in the order of `files`.
std::vector<double> positions_of(const std::vector<StackedPlanes>& files) {
  std::vector<double> positions;
  for (const StackedPlanes& file : files) {
    for (std::int64_t i = 0; i < file.count; ++i) {
      positions.push_back(file.coordinates.empty() ? file.first + static_cast<double>(i) * file.spacing
                                                   : file.coordinates[static_cast<std::size_t>(i)]);
    }
  }
  return positions;
}

double first_of(const StackedPlanes& file) { return file.coordinates.empty() ? file.first : file.coordinates.front(); }

std::string coordinates_text(const AxisDetails& axis) {
  return axis.coordinates.empty() ? "equally spaced"
                                  : cat("from ", axis.coordinates.front(), " to ", axis.coordinates.back());
}

bool are_placed(const std::vector<StackedPlanes>& files) {
  std::uint64_t planes = 0;
  for (const StackedPlanes& file : files) planes += static_cast<std::uint64_t>(file.count);
  const StackedPlanes& first = files.front();
  return planes <= kMaxCoordinates &&
         std::all_of(files.begin(), files.end(), [](const StackedPlanes& file) { return file.placed; }) &&
         std::any_of(files.begin(), files.end(), [&](const StackedPlanes& file) {
           return !nearly(first_of(file), first_of(first), first.spacing);
         });
}

AxisPlace axis_of(std::vector<double> positions) {
  AxisPlace axis;
  axis.extent = std::ssize(positions);
  place_by_coordinates(std::move(positions), kPlanePrecision, axis);
  return axis;
}

// Throws unless all positions rise, or all fall, as the first two do.
void check_order(const std::vector<StackedPlanes>& files, const std::vector<double>& positions) {
  const bool falls = positions[1] < positions[0];
  std::size_t at = 0;
  for (std::size_t i = 0; i < files.size(); ++i) {
    for (std::int64_t plane = 0; plane < files[i].count; ++plane, ++at) {
      if (at == 0 || (falls ? positions[at] < positions[at - 1] : positions[at] > positions[at - 1])) continue;
      throw input_error(
          files[i].path,
          compose("its plane at z = ", positions[at], " is not ", falls ? "below" : "above", " the one before it, at ",
                  positions[at - 1], " in ", plane > 0 ? "it" : files[i - 1].path, "; rename the files, or give ",
                  option("spacing"), " to take them as they are"));
    }
  }
}

bool is_aligned(const SourceInfo& info) { return info.details.orientation.empty() || info.details.points_down; }

}  // namespace

double first_position(const SourceInfo& info, std::size_t axis) {
  const Index3& at = info.index_origin;
  const std::int64_t index = axis == 0 ? at.x : axis == 1 ? at.y : at.z;
  return info.origin.at(axis) + static_cast<double>(index) * info.spacing.at(axis);
}

StackedPlanes stacked_planes(const std::string& path, const SourceInfo& info) {
  const AxisDetails& z = info.details.axes[2];
  const bool irregular = !z.reversed && !z.note.empty();
  // A step along an axis that falls, or is oblique to the world's axes, is not a step along the world's z.
  const bool aligned = is_aligned(info);
  return {path,
          info.extent.z,
          first_position(info, 2),
          info.spacing[2],
          z.coordinates,
          aligned && (!irregular || std::ssize(z.coordinates) == info.extent.z),
          z.reversed};
}

void check_placed_alike(const std::string& path, const SourceInfo& info, const SourceInfo& first) {
  const auto differ = [&](std::string_view what, const std::string& found, const std::string& expected) {
    return input_error(
        path, compose(what, ' ', found, " differs from ", expected, " of ", first.path,
                      "; a stack's files must be alike, or give ", option("spacing"), " to take them as they are"));
  };
  const std::string& orientation = info.details.orientation;
  if (orientation != first.details.orientation) {
    throw differ("orientation", '"' + orientation + '"', '"' + first.details.orientation + '"');
  }
  const auto& time = info.details.time;
  const auto& first_time = first.details.time;
  if (time && first_time && time->value != first_time->value) {
    throw differ("time", cat(time->value), cat(first_time->value));
  }
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const std::string name(1, "xy"[axis]);
    const double spacing = first.spacing.at(axis);
    if (!nearly(info.spacing.at(axis), spacing, spacing)) {
      throw differ("spacing along " + name, cat(info.spacing.at(axis)), cat(spacing));
    }
    if (is_aligned(info) && !nearly(first_position(info, axis), first_position(first, axis), spacing)) {
      throw differ("origin along " + name, cat(first_position(info, axis)), cat(first_position(first, axis)));
    }
    const AxisDetails& found = info.details.axes.at(axis);
    const AxisDetails& expected = first.details.axes.at(axis);
    const auto order = [](const AxisDetails& a) { return std::string(a.reversed ? "falling" : "rising"); };
    if (found.reversed != expected.reversed) {
      throw differ("order of coordinates along " + name, order(found), order(expected));
    }
    if (found.coordinates != expected.coordinates) {
      throw differ("irregular axis " + name, coordinates_text(found), coordinates_text(expected));
    }
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::string& found = info.details.axes.at(axis).units;
    const std::string& expected = first.details.axes.at(axis).units;
    if (found != expected) throw differ(cat("unit of axis ", "xyz"[axis]), '"' + found + '"', '"' + expected + '"');
  }
  if (info.units != first.units) throw differ("unit of the values", '"' + info.units + '"', '"' + first.units + '"');
}

bool stacked_backwards(const std::vector<StackedPlanes>& files, bool by_position) {
  for (const StackedPlanes& file : files) {
    if (file.reversed == files.front().reversed) continue;
    const StackedPlanes& falls = file.reversed ? file : files.front();
    throw input_error(falls.path,
                      "its planes are read in reverse order, since their coordinates fall, and those of "
                      "other files of the stack are not; a stack's files must be alike");
  }
  if (files.front().reversed) return true;
  const bool single =
      std::all_of(files.begin(), files.end(), [](const StackedPlanes& file) { return file.count == 1; });
  return by_position && single && are_placed(files) && axis_of(positions_of(files)).falls;
}

void place_planes(const std::vector<StackedPlanes>& files, bool backwards, SourceInfo& info) {
  if (!are_placed(files)) return;
  const std::vector<double> positions = positions_of(files);
  check_order(files, positions);
  AxisPlace axis = axis_of(positions);
  axis.units = info.details.axes[2].units;
  if (backwards && axis.spacing) {
    axis.falls = true;
    axis.note = cat("falls from ", positions.back(), " to ", positions.front());
  }
  info.spacing[2] = axis.spacing.value_or(info.spacing[2]);
  info.origin[2] = axis.origin.value_or(positions.front());
  info.details.axes[2] = axis_details(axis, 2);
}

}  // namespace weir
