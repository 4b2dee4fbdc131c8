// Two materials that few bits hold, mixed voxel by voxel, and voxels without a value among them.
#pragma once

#include <cstdint>
#include <limits>

#include "tests/compressor/support/memory_volume.h"

namespace weir::test {

/// 0 or 1 in a cube of `side` voxels; one voxel of 50 is NaN.
inline MemoryVolume two_materials(std::int64_t side) {
  return MemoryVolume({{0, 0, 0}, {side, side, side}}, [side](const Index3& i) {
    const auto n = static_cast<std::uint32_t>(i.x + side * (i.y + side * i.z)) * 2654435761U >> 9U;
    return n % 50 == 0 ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(n % 2);
  });
}

}  // namespace weir::test
