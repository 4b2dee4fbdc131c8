// Whether boxes of any number of axes cover another one. Pure arithmetic.
#pragma once

#include <hdf5.h>
#include <optional>
#include <span>
#include <vector>

namespace weir {

/// Half open along each axis, slowest first.
struct AxisBox {
  std::vector<hsize_t> lo;
  std::vector<hsize_t> hi;
};

/// The first element (in row-major order of the cells that the boxes' edges make) of `whole` that none of
/// `covers` holds; nullopt where they cover it. All have as many axes; `whole` is not empty.
std::optional<std::vector<hsize_t>> first_uncovered(const AxisBox& whole, std::span<const AxisBox> covers);

}  // namespace weir
