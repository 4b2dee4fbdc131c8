// Whether boxes of any number of axes cover another one. Pure arithmetic.
#pragma once

#include <hdf5.h>

#include <cstdint>
#include <span>
#include <vector>

namespace weir {

/// Half open along each axis, slowest first.
struct AxisBox {
  std::vector<hsize_t> lo;
  std::vector<hsize_t> hi;
};

/// Elements of a box that no other holds.
struct Uncovered {
  std::uint64_t count = 0;
  std::vector<hsize_t> first;  ///< in row-major order; empty where there is none
};

/// The elements of `whole` that none of `covers` holds. All have as many axes; `whole` is not empty, and 64 bits count
/// its elements.
Uncovered uncovered(const AxisBox& whole, std::span<const AxisBox> covers);

}  // namespace weir
