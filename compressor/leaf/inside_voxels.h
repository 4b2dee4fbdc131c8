// The in-domain voxels of a leaf.
#pragma once

#include <cstddef>
#include <cstdint>

#include "format/base/index.h"

namespace weir {

/// Calls visit(i) for every voxel of `inside` in the leaf at `node`, in leaf order: i is x << 6 | y << 3 | z.
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

}  // namespace weir
