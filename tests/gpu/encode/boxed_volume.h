// The blocks of a small volume, in the form that the device's steps take.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "gpu/cuda/encode/encode_call.h"
#include "tests/support/block_volumes.h"

namespace weir::encode_steps_test {

using Values = std::array<float, 512>;  // x << 6 | y << 3 | z

// The blocks of a volume. The first block begins `before` voxels before the first value.
struct Boxed {
  BlockBox box;
  explicit Boxed(const test::BlockVolume& volume, const Index3& before) {
    box.values = volume.values.data();
    const std::int64_t extent[3] = {volume.extent.x, volume.extent.y, volume.extent.z};
    const std::int64_t ahead[3] = {before.x, before.y, before.z};
    for (int axis = 0; axis < 3; ++axis) {
      box.extent[axis] = static_cast<std::int32_t>(extent[axis]);
      box.corner[axis] = -static_cast<std::int32_t>(ahead[axis]);
      box.blocks[axis] = static_cast<std::uint32_t>((extent[axis] + ahead[axis] + 7) / 8);
    }
  }
  Values block(std::uint32_t b) const {
    const std::uint32_t at[3] = {b % box.blocks[0], b / box.blocks[0] % box.blocks[1],
                                 b / box.blocks[0] / box.blocks[1]};
    Values values;
    for (std::int32_t i = 0; i < 512; ++i) {
      const std::int32_t inside[3] = {i >> 6, i >> 3 & 7, i & 7};
      std::int64_t voxel[3];
      for (int axis = 0; axis < 3; ++axis) {
        voxel[axis] = std::clamp(box.corner[axis] + 8 * static_cast<std::int32_t>(at[axis]) + inside[axis], 0,
                                 box.extent[axis] - 1);
      }
      values[static_cast<std::size_t>(i)] =
          box.values[voxel[0] + box.extent[0] * (voxel[1] + box.extent[1] * voxel[2])];
    }
    return values;
  }
};

inline constexpr Index3 kBefores[] = {{0, 0, 0}, {5, 0, 3}};

inline bool all_finite(const Values& values) {
  return std::all_of(values.begin(), values.end(), [](float v) { return std::isfinite(v); });
}

}  // namespace weir::encode_steps_test
