// At which time a volume lies: by its position on an axis of time, and by times that are no axis's coordinates.
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

/// Times beside an array: one for all of it, or one for each element of its axis of time.
struct TimeValues {
  std::vector<double> values;
  std::string units;     ///< "hours since 2000-01-01"; else empty
  std::string calendar;  ///< of CF; else empty
};

/// Where a volume lies on an array's axis of time.
struct TimePosition {
  std::size_t at = 0;
  std::size_t extent = 0;               ///< elements of the axis; 0 where there is none
  std::size_t dimension = 0;            ///< the same and AxisPlace::unwritten ones
  std::optional<TimePoint> coordinate;  ///< what the axis itself says of the position

  /// The one of `times` that is the volume's; nullopt where they are not as many as the axis or its dimension has
  /// elements.
  std::optional<TimePoint> in(const TimeValues& times) const;
};

/// The position of a volume at `index` of `leading`, the axes that are not the volume's, in the same order: that on the
/// first axis of time with coordinates or a spacing; else on the last axis of time.
TimePosition time_position(std::span<const AxisPlace* const> leading, std::span<const std::int64_t> index);

}  // namespace weir
