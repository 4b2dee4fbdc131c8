// What encoding records of each kept leaf for the nodes above it: its statistics in double, and the bounds of its outer
// layers, which reach into the aprons of neighbouring macrocells; and what decoding it has changed.
#pragma once

#include <array>
#include <cstdint>

#include "format/leaf/bounds.h"

namespace weir {

/// What decoding keeps of voxels, bit for bit. Of several the least counts.
enum class Kept : std::uint32_t {
  lossy,   ///< a value reads another one
  values,  ///< every value, but not what is to take the place of voxels without one
  all
};

/// By whether every value is kept, and whether all bits are, those in place of voxels without a value among them.
constexpr Kept kept_of(bool every_value, bool every_bit) {
  return every_bit ? Kept::all : every_value ? Kept::values : Kept::lossy;
}

struct LeafRecord {
  double mean = 0;
  double m2 = 0;
  MinMax bounds = kNoBounds;  ///< of the in-domain values, NaN left out
  /// Bounds of the layer that faces out of the leaf's macrocell: entry d - 1, bit 0 of d for the x side,
  /// bit 1 for y, bit 2 for z. A leaf of an even coordinate faces down, of an odd one up.
  std::array<MinMax, 7> outward{kNoBounds, kNoBounds, kNoBounds, kNoBounds, kNoBounds, kNoBounds, kNoBounds};
  // Of a quantised leaf, decoded, over the finite in-domain values.
  double squared_error = 0;
  double max_abs = 0;
  Kept kept = Kept::all;
  std::uint32_t zeros_lost = 0;  ///< zeros that read another value
  // Where not all in-domain voxels are active: mean and m2 are those of the active ones, bounds those of all.
  MinMax active = kNoBounds;                 ///< bounds of the active values
  std::uint16_t inactive = 0;                ///< how many in-domain voxels are not
  std::array<std::uint8_t, 3> active_lo{};   ///< of the box of active voxels, from the leaf's corner
  std::array<std::uint8_t, 3> active_end{};  ///< the same, one beyond the last
};
static_assert(sizeof(LeafRecord) == 120, "records are spilled as they are");

}  // namespace weir
