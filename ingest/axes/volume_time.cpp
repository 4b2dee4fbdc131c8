#include "ingest/axes/volume_time.h"

#include <algorithm>

namespace weir {

std::optional<TimePoint> TimePosition::in(const TimeValues& times) const {
  const std::size_t count = times.values.size();
  if (count == 0 || (count != 1 && count != extent && count != dimension)) return std::nullopt;
  return TimePoint{times.values[count == 1 ? 0 : at], times.units, times.calendar};
}

TimePosition time_position(std::span<const AxisPlace* const> leading, std::span<const std::int64_t> index) {
  TimePosition position;
  for (std::size_t i = 0; i < std::min(leading.size(), index.size()); ++i) {
    const AxisPlace& axis = *leading[i];
    if (!axis.is_time) continue;
    position.at = static_cast<std::size_t>(index[i]);
    position.extent = static_cast<std::size_t>(axis.extent);
    position.dimension = static_cast<std::size_t>(axis.extent + axis.unwritten);
    if (position.at < axis.coordinates.size()) {
      position.coordinate = TimePoint{axis.coordinates[position.at], axis.units, axis.calendar};
    } else if (axis.spacing) {
      const double value = static_cast<double>(position.at) * *axis.spacing + axis.origin.value_or(0.0);
      position.coordinate = TimePoint{value, axis.units, axis.calendar};
    }
    if (position.coordinate) break;
  }
  return position;
}

}  // namespace weir
