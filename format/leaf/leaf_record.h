// The record that encoding keeps of each kept leaf for the nodes above it: its statistics in double, the bounds of its
// outer layers, which reach into the aprons of neighbouring macrocells, and what decoding changes.
#pragma once

#include <array>
#include <cstdint>

#include "format/leaf/bounds.h"

namespace weir {

/// How much decoding keeps of voxels, bit for bit. For several voxels the smallest value counts.
enum class Kept : std::uint32_t {
  lossy,   ///< a value decodes to another value
  values,  ///< every value, but not the replacement of voxels without a value
  all
};

/// Returns the Kept for whether every value is kept and whether every bit is kept. The bits include those that stand
/// for voxels without a value.
constexpr Kept kept_of(bool every_value, bool every_bit) {
  return every_bit ? Kept::all : every_value ? Kept::values : Kept::lossy;
}

struct LeafRecord {
  double mean = 0;
  double m2 = 0;
  MinMax bounds = kNoBounds;  ///< of the in-domain values, without NaN
  /// Bounds of the layers that face out of the leaf's macrocell: entry d - 1, with bit 0 of d for the x side, bit 1 for
  /// y, bit 2 for z. A leaf at an even coordinate faces down, at an odd coordinate up.
  std::array<MinMax, 7> outward{kNoBounds, kNoBounds, kNoBounds, kNoBounds, kNoBounds, kNoBounds, kNoBounds};
  // For a quantised leaf: errors of the decoded values, over the finite in-domain values.
  double squared_error = 0;
  double max_abs = 0;
  Kept kept = Kept::all;
  std::uint32_t zeros_lost = 0;  ///< zeros that decode to another value
  // For a leaf with inactive in-domain voxels: `mean` and `m2` are over the active voxels, `bounds` over all.
  MinMax active = kNoBounds;                 ///< bounds of the active values
  std::uint16_t inactive = 0;                ///< number of inactive in-domain voxels
  std::array<std::uint8_t, 3> active_lo{};   ///< lowest corner of the box of active voxels, from the leaf's corner
  std::array<std::uint8_t, 3> active_end{};  ///< the box's end: one beyond its last voxel
};
static_assert(sizeof(LeafRecord) == 120, "records are spilled as they are");

}  // namespace weir
