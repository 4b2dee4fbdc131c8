// Values of a leaf that are known to repeat each other, as values of coarse cells do on a finer grid.
#pragma once

#include <cstddef>

#include "format/base/index.h"
#include "ingest/plan/repeat_groups.h"

namespace weir {

/// Says which terms a sum over the 512 values of a leaf (eight in a row, 64 in a plane) need not compute again. The sum
/// itself stays the same, addition by addition.
struct LeafRepeats {
  /// The numbers of consecutive equal planes, equal rows of a plane and, if known, equal values of a row. All are 1 if
  /// rows do not repeat.
  LeafGroups groups{};

  /// Returns the repeats of values in the source's order, x fastest, that are equal in groups of `by` voxels.
  static LeafRepeats in_source_order(const Index3& by) { return of(by.z, by.y, 1); }
  /// Returns the repeats of values in a leaf's order, z fastest, that are equal in groups of `by` voxels.
  static LeafRepeats in_leaf_order(const Index3& by) { return of(by.x, by.y, by.z); }

  /// Returns whether the second row of each pair of rows equals the first.
  bool pairs_of_rows() const { return groups.middle > 1; }
  /// Returns the number of values in a group.
  std::size_t times() const { return groups.slow * groups.middle * groups.fast; }

 private:
  static LeafRepeats of(std::int64_t slow, std::int64_t middle, std::int64_t fast) {
    if (middle <= 1) return {};
    return {{static_cast<std::size_t>(slow), static_cast<std::size_t>(middle), static_cast<std::size_t>(fast)}};
  }
};

/// The number of pairs of rows in a plane. The first row of pair k begins at value kTwinStep * k of the plane.
inline constexpr std::size_t kTwins = 4;
inline constexpr std::size_t kTwinStep = 16;
inline constexpr std::size_t kTwinPlane = kTwins * kTwinStep;

/// Copies the first of each group of the 512 values to `distinct` and returns their number.
template <typename Value>
std::size_t take_distinct(const Value* values, const LeafGroups& groups, Value* distinct) {
  std::size_t count = 0;
  for (std::size_t s = 0; s < 8; s += groups.slow) {
    for (std::size_t m = 0; m < 8; m += groups.middle) {
      for (std::size_t f = 0; f < 8; f += groups.fast) distinct[count++] = values[s << 6U | m << 3U | f];
    }
  }
  return count;
}

}  // namespace weir
