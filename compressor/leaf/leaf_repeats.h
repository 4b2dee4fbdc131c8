// Values of a leaf that are known to repeat each other, as those of coarse cells do on a finer grid.
#pragma once

#include <cstddef>
#include <cstdint>

namespace weir {

/// What sums over the 512 values of a leaf, eight in a row and 64 in a plane, need not compute again. The sums
/// themselves are the same, addition by addition.
struct LeafRepeats {
  bool twins = false;      ///< the second of each two rows is the first
  std::size_t planes = 1;  ///< as many planes, from each multiple of this on, are the same: 1, 2, 4 or 8

  /// Of groups of so many voxels along the axes that rows, what rows lie beside each other along, and planes have.
  static LeafRepeats of(std::int64_t rows, std::int64_t planes) {
    return rows > 1 ? LeafRepeats{true, static_cast<std::size_t>(planes)} : LeafRepeats{};
  }
};

/// Pairs of rows in a plane; the first row of pair k of a plane begins at its value kTwinStep * k.
inline constexpr std::size_t kTwins = 4;
inline constexpr std::size_t kTwinStep = 16;
inline constexpr std::size_t kTwinPlane = kTwins * kTwinStep;

}  // namespace weir
