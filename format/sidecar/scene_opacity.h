// The opacity over the values in a scene, as one table. The renderer and, with a scene, the compressor use it to decide
// whether a value can be seen.
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <vector>

#include "format/sidecar/scene.h"

namespace weir {

/// Entries of the tables: an entry lies within half a thousandth of the range from every control point.
inline constexpr std::size_t kTransferEntries = 1024;

/// Returns the value at position `at` of a piecewise-linear function given by points with rising `position`; the ends
/// extend. `value` reads a point's value, `mix(a, b, f)` blends two.
template <class Point, class Value, class Mix>
auto interpolate(const std::vector<Point>& points, double at, const Value& value, const Mix& mix) {
  const auto above = std::find_if(points.begin(), points.end(), [&](const Point& p) { return p.position >= at; });
  if (above == points.begin()) return value(points.front());
  if (above == points.end()) return value(points.back());
  const auto below = above - 1;
  const auto f = static_cast<float>((at - below->position) / (above->position - below->position));
  return mix(value(*below), value(*above), f);
}

/// Returns the opacity at kTransferEntries equal distances over [0, 1]. `points` is not empty.
std::vector<float> opacity_table(const std::vector<OpacityPoint>& points);

/// A band of opacity between two entries of opacity_table() that no look-up returns.
struct MissedBand {
  double from;  ///< positions of the band's first and last point
  double to;
  double opacity;  ///< the highest opacity of its points
  double shown;    ///< the most that look-ups return there: the higher of the entries around it
};

/// Returns the band or peak that loses most of its opacity in opacity_table(), among those that lose more than a tenth;
/// none if there are none. `points` is not empty.
std::optional<MissedBand> missed_band(const std::vector<OpacityPoint>& points);

}  // namespace weir
