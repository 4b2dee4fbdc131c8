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

constexpr double kPlanePrecision = std::numeric_limits<float>::epsilon();  // headers round to a few digits

bool nearly(double a, double b, double spacing) {
  return std::fabs(a - b) <=
         kRegularTolerance * std::fabs(spacing) + kPlanePrecision * std::max(std::fabs(a), std::fabs(b));
}

// Of all planes, in the order of `files`.
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
  return planes <= kMaxCoordinates &&
         std::all_of(files.begin(), files.end(), [](const StackedPlanes& file) { return file.placed; }) &&
         std::any_of(files.begin(), files.end(),
                     [&](const StackedPlanes& file) { return first_of(file) != first_of(files.front()); });
}

bool single_planes(const std::vector<StackedPlanes>& files) {
  return std::all_of(files.begin(), files.end(), [](const StackedPlanes& file) { return file.count == 1; });
}

// The first file whose planes do not come after those of the one before.
void check_rising(const std::vector<StackedPlanes>& files, const std::vector<double>& positions) {
  std::size_t at = 0;
  for (std::size_t i = 0; i + 1 < files.size(); ++i) {
    at += static_cast<std::size_t>(files[i].count);
    if (positions[at] > positions[at - 1]) continue;
    throw input_error(
        files[i + 1].path,
        compose("its planes begin at z = ", positions[at], ", not after those of ", files[i].path, ", which end at ",
                positions[at - 1], "; rename the files, or give ", option("spacing"), " to take them as they are"));
  }
}

}  // namespace

double first_position(const SourceInfo& info, std::size_t axis) {
  const Index3& at = info.index_origin;
  const std::int64_t index = axis == 0 ? at.x : axis == 1 ? at.y : at.z;
  return info.origin.at(axis) + static_cast<double>(index) * info.spacing.at(axis);
}

StackedPlanes stacked_planes(const std::string& path, const SourceInfo& info) {
  const AxisDetails& z = info.details.axes[2];
  const bool irregular = !z.reversed && !z.note.empty();
  return {path,
          info.extent.z,
          first_position(info, 2),
          info.spacing[2],
          z.coordinates,
          !irregular || std::ssize(z.coordinates) == info.extent.z,
          z.reversed};
}

void check_placed_alike(const std::string& path, const SourceInfo& info, const SourceInfo& first) {
  const auto differ = [&](std::string_view what, const std::string& found, const std::string& expected) {
    return input_error(
        path, compose(what, ' ', found, " differs from ", expected, " of ", first.path,
                      "; a stack's files must be alike, or give ", option("spacing"), " to take them as they are"));
  };
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const std::string name(1, "xy"[axis]);
    const double spacing = first.spacing.at(axis);
    if (!nearly(info.spacing.at(axis), spacing, spacing)) {
      throw differ("spacing along " + name, cat(info.spacing.at(axis)), cat(spacing));
    }
    if (!nearly(first_position(info, axis), first_position(first, axis), spacing)) {
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

bool stacked_backwards(const std::vector<StackedPlanes>& files) {
  for (const StackedPlanes& file : files) {
    if (file.reversed == files.front().reversed) continue;
    const StackedPlanes& falls = file.reversed ? file : files.front();
    throw input_error(falls.path,
                      "its planes are read in reverse order, since their coordinates fall, and those of "
                      "other files of the stack are not; a stack's files must be alike");
  }
  if (files.front().reversed) return true;
  return single_planes(files) && are_placed(files) && first_of(files.back()) < first_of(files.front());
}

void place_planes(const std::vector<StackedPlanes>& files, bool backwards, SourceInfo& info) {
  if (!are_placed(files)) return;
  std::vector<double> positions = positions_of(files);
  check_rising(files, positions);
  AxisPlace axis;
  axis.extent = info.extent.z;
  axis.units = info.details.axes[2].units;
  const std::string falls = cat("falls from ", positions.back(), " to ", positions.front());
  place_by_coordinates(std::move(positions), kPlanePrecision, axis);
  if (backwards && axis.spacing) {
    axis.falls = true;
    axis.note = falls;
  }
  info.spacing[2] = axis.spacing.value_or(1.0);
  info.origin[2] = axis.origin.value_or(0.0);
  info.details.axes[2] = axis_details(axis, 2);
}

}  // namespace weir
