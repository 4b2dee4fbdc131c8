// Visits the in-domain voxels of a leaf, and extends their values to the voxels outside the domain.
#pragma once

#include <cstddef>
#include <cstdint>

#include "format/base/index.h"

namespace weir {

/// Calls visit(i) for every voxel of `inside` in the leaf at `node`, in leaf order. i is x << 6 | y << 3 | z.
template <typename Visit>
void for_each_inside(const Box& node, const Box& inside, const Visit& visit) {
  const Index3 lo = inside.lo - node.lo;
  const Index3 hi = inside.hi - node.lo;
  for (std::int64_t x = lo.x; x < hi.x; ++x) {
    for (std::int64_t y = lo.y; y < hi.y; ++y) {
      for (std::int64_t z = lo.z; z < hi.z; ++z) visit(static_cast<std::size_t>(x << 6 | y << 3 | z));
    }
  }
}

/// Gives each voxel outside `inside` the value of the nearest voxel inside, the smoothest extension that needs no
/// bounds. Every layer of the leaf then stays within the bounds of its inside part. `values`, of kLeafVoxels, are in
/// leaf order.
template <typename Values>
void extend_outside(const Box& node, const Box& inside, Values& values) {
  if (inside == node) return;
  const Index3 lo = inside.lo - node.lo;
  const Index3 last = inside.hi - node.lo - Index3{1, 1, 1};
  for (std::int64_t i = 0; i < kLeafVoxels; ++i) {
    const Index3 nearest = max(lo, min(last, Index3{i >> 6, i >> 3 & 7, i & 7}));
    values[static_cast<std::size_t>(i)] = values[static_cast<std::size_t>(nearest.x << 6 | nearest.y << 3 | nearest.z)];
  }
}

}  // namespace weir
