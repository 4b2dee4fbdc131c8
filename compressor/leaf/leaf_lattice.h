// Values that lie on a lattice: whole numbers, or multiples of a step that a
// float holds exactly. Quantised with that step, a leaf loses nothing.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

namespace weir {

struct LeafLattice {
  float step = 0;             ///< > 0: value = min + code * step, without rounding
  std::uint32_t largest = 0;  ///< code of the largest value, 1..65535
};

/// The coarsest lattice that holds every one of `values` (1 to 512 finite ones, not all equal), where
/// fl(fl(code * step) + min) gives back each value bit for bit and no code needs more than 16 bits;
/// nullopt where there is none. A leaf that holds -0.0 has none: no sum gives it back.
std::optional<LeafLattice> find_lattice(std::span<const float> values, float min, float max);

/// Bits a voxel, a power of two of 1 to 16, that hold codes up to `largest`, which is at most 65535.
unsigned bits_for(std::uint32_t largest);

}  // namespace weir
