// Bounds of values, which widen as values are added.
#pragma once

#include <limits>

namespace weir {

struct MinMax {
  float min;
  float max;
};

/// The bounds of no values: any value widens them.
inline constexpr MinMax kNoBounds{std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity()};

inline void widen(MinMax& bounds, const MinMax& by) {
  if (by.min < bounds.min) bounds.min = by.min;
  if (by.max > bounds.max) bounds.max = by.max;
}

}  // namespace weir
