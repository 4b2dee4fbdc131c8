// Finds the time of a volume: from its position on a time axis, and from times that are not the coordinates of an
// axis.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "ingest/axes/axis_place.h"
#include "ingest/source/field_details.h"

namespace weir {

/// Times stored beside an array: one for the whole array, or one for each element of its time axis.
struct TimeValues {
  std::vector<double> values;
  std::string units;     ///< "hours since 2000-01-01"; else empty
  std::string calendar;  ///< CF calendar; else empty
};

/// The position of a volume on an array's time axis.
struct TimePosition {
  std::size_t at = 0;
  std::size_t extent = 0;               ///< elements of the axis; 0 if there is none
  std::size_t dimension = 0;            ///< `extent` plus AxisPlace::unwritten
  std::optional<TimePoint> coordinate;  ///< the axis's own coordinate at the position

  /// Returns the volume's entry of `times`. Returns nullopt if `times` does not have as many values as the axis or
  /// its dimension has elements.
  std::optional<TimePoint> in(const TimeValues& times) const;
};

/// Returns the time position of a volume at `index` of `leading`, the axes that are not the volume's, in the same
/// order. This is the position on the first time axis with coordinates or a spacing, otherwise on the last time axis.
TimePosition time_position(std::span<const AxisPlace* const> leading, std::span<const std::int64_t> index);

}  // namespace weir
