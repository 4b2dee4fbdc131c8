#include "ingest/axes/coordinates.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <utility>

#include "format/base/text.h"

namespace weir {
namespace {

// Returns the shortest text that reads back as the same value, or as the same float32 if `precision` is that of
// float32.
std::string coordinate_text(double value, double precision) {
  std::array<char, 32> text{};
  const bool single = precision >= static_cast<double>(std::numeric_limits<float>::epsilon());
  const auto end = single ? std::to_chars(text.data(), text.data() + text.size(), static_cast<float>(value))
                          : std::to_chars(text.data(), text.data() + text.size(), value);
  return {text.data(), end.ptr};
}

void place(std::span<const double> coordinates, double precision, AxisPlace& axis) {
  if (coordinates.empty()) return;
  const double first = coordinates.front();
  const double last = coordinates.back();
  if (coordinates.size() == 1) {
    axis.origin = first;
    return;
  }
  const std::string from_to =
      cat(" from ", coordinate_text(first, precision), " to ", coordinate_text(last, precision));
  const double spacing = (last - first) / static_cast<double>(coordinates.size() - 1);
  const double tolerance =
      kRegularTolerance * std::fabs(spacing) + precision * std::max(std::fabs(first), std::fabs(last));
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    const double regular = first + static_cast<double>(i) * spacing;
    if (spacing == 0.0 || !std::isfinite(spacing) || std::fabs(coordinates[i] - regular) > tolerance) {
      axis.note = cat("irregular coordinates", from_to, ", taken as indices");
      return;
    }
  }
  axis.spacing = std::fabs(spacing);
  axis.origin = std::min(first, last);
  axis.falls = spacing < 0.0;
  if (axis.falls) axis.note = cat("falls", from_to);
}

}  // namespace

void place_by_coordinates(std::vector<double> coordinates, double precision, AxisPlace& axis) {
  const bool finite = std::all_of(coordinates.begin(), coordinates.end(), [](double c) { return std::isfinite(c); });
  if (finite) {
    place(coordinates, precision, axis);
  } else {
    axis.note = "coordinates that are missing or not finite, taken as indices";
  }
  if (axis.is_time || (!axis.spacing && finite)) axis.coordinates = std::move(coordinates);
  if (axis.is_time) axis.falls = false;
}

}  // namespace weir
