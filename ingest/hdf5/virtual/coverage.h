// Finds the elements of a box that other boxes do not cover, for any number of axes. Pure arithmetic.
#pragma once

#include <hdf5.h>

#include <cstdint>
#include <span>
#include <vector>

namespace weir {

/// A box that is half open along each axis, slowest axis first.
struct AxisBox {
  std::vector<hsize_t> lo;
  std::vector<hsize_t> hi;
};

/// The elements of a box that no other box holds.
struct Uncovered {
  std::uint64_t count = 0;
  std::vector<hsize_t> first;  ///< the first in row-major order; empty if there is none
};

/// Returns the elements of `whole` that no box of `covers` holds. All boxes have the same number of axes. `whole` is
/// not empty, and its element count fits in 64 bits.
Uncovered uncovered(const AxisBox& whole, std::span<const AxisBox> covers);

}  // namespace weir
