// A volume of two materials, mixed voxel by voxel, with voxels without a value among them. Few bits hold its values.
#pragma once

#include <cstdint>
#include <limits>

#include "tests/compressor/support/memory_volume.h"

namespace weir::test {

/// Returns a cube of `side` voxels along each axis with values 0 or 1. One voxel in 50 is NaN.
inline MemoryVolume two_materials(std::int64_t side) {
  return MemoryVolume({{0, 0, 0}, {side, side, side}}, [side](const Index3& i) {
    const auto n = static_cast<std::uint32_t>(i.x + side * (i.y + side * i.z)) * 2654435761U >> 9U;
    return n % 50 == 0 ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(n % 2);
  });
}

}  // namespace weir::test
