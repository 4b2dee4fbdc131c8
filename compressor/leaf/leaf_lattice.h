// Values that lie on a lattice: whole numbers, or multiples of a step that a float holds exactly. A leaf loses nothing
// when it is quantised with this step.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

namespace weir {

struct LeafLattice {
  float step = 0;             ///< > 0: value = min + code * step, without rounding
  std::uint32_t largest = 0;  ///< code of the largest value, 1..65535
};

/// Returns the coarsest lattice that holds every one of `values` (1 to 512 finite values, not all equal). Then
/// fl(fl(code * step) + min) gives each value bit for bit, and no code needs more than 16 bits. Returns nullopt if
/// there is no such lattice. A leaf that holds -0.0 has none, because no sum gives -0.0.
std::optional<LeafLattice> find_lattice(std::span<const float> values, float min, float max);

/// Returns the bits per voxel (1, 2, 4, 8 or 16) that hold codes up to `largest`, which is at most 65535.
unsigned bits_for(std::uint32_t largest);

}  // namespace weir
