// Opacity over the values as a scene gives it, in one table that the renderer and, with a scene, the compressor share
// to decide whether a value can be seen.
#pragma once

#include <algorithm>
#include <cstddef>
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

}  // namespace weir
