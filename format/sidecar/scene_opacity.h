// Opacity over the values as a scene gives it, in one table that the renderer and, with a scene, the compressor share
// to decide whether a value can be seen.
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <vector>

#include "format/sidecar/scene.h"

namespace weir {

/// Entries of the tables: a control point is met within half a thousandth of the range.
inline constexpr std::size_t kTransferEntries = 1024;

/// Value at position `at` of a piecewise-linear function given by points with rising `position`, ends extended;
/// `value` reads it from a point, `mix(a, b, f)` blends two.
template <class Point, class Value, class Mix>
auto interpolate(const std::vector<Point>& points, double at, const Value& value, const Mix& mix) {
  const auto above = std::find_if(points.begin(), points.end(), [&](const Point& p) { return p.position >= at; });
  if (above == points.begin()) return value(points.front());
  if (above == points.end()) return value(points.back());
  const auto below = above - 1;
  const auto f = static_cast<float>((at - below->position) / (above->position - below->position));
  return mix(value(*below), value(*above), f);
}

/// Opacity at kTransferEntries equal distances over [0, 1]. `points` is not empty.
std::vector<float> opacity_table(const std::vector<OpacityPoint>& points);

/// Opacity between two entries of that table which no look-up gives.
struct MissedBand {
  double from;  ///< positions of the first and the last of its points
  double to;
  double opacity;  ///< the highest of its points
  double shown;    ///< the most that look-ups give there: the higher of the entries around it
};

/// Of the bands and peaks that lose more than a tenth of their opacity in opacity_table, the one that loses most; none
/// where all are met. `points` is not empty.
std::optional<MissedBand> missed_band(const std::vector<OpacityPoint>& points);

}  // namespace weir
