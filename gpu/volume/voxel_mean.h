// The mean of the voxels of a cube, added block by block. For host and device.
#pragma once

#include <cstdint>

#include "gpu/math/vector3.h"
#include "gpu/volume/level_lattice.h"

namespace weir {

/// The mean counts only finite values.
struct VoxelMean {
  double sum = 0;
  double count = 0;

  /// Adds the voxels [low, high) of a block's 512, counted from its lowest corner; value index x << 6 | y << 3 | z.
  WEIR_HOST_DEVICE void add(const float* values, const Int3& low, const Int3& high) {
    for (std::int32_t x = low.x; x < high.x; ++x) {
      for (std::int32_t y = low.y; y < high.y; ++y) {
        for (std::int32_t z = low.z; z < high.z; ++z) add(values[x << 6 | y << 3 | z], 1.0);
      }
    }
  }
  /// Adds `value` with weight `weight`.
  WEIR_HOST_DEVICE void add(float value, double weight) {
    if (!is_finite(value)) return;
    sum += weight * static_cast<double>(value);
    count += weight;
  }
  /// Returns the mean; NaN if no value was finite.
  WEIR_HOST_DEVICE float value() const { return static_cast<float>(sum / count); }
};

/// Returns texel `i` of level `level` + 1. Each texel of `level` counts with the weight of its voxels.
WEIR_HOST_DEVICE inline float coarser_texel(const LevelLattice& lattice, int level, const float* texels,
                                            const Int3& i) {
  const Int3 from = lattice.first(level);
  const Int3 to = lattice.first(level + 1);
  const Int3 n = lattice.texels(level);
  VoxelMean mean;
  for (std::int32_t k = 0; k < 8; ++k) {
    const Int3 child{2 * (to.x + i.x) + (k & 1) - from.x, 2 * (to.y + i.y) + (k >> 1 & 1) - from.y,
                     2 * (to.z + i.z) + (k >> 2) - from.z};
    if (child.x < 0 || child.y < 0 || child.z < 0 || child.x >= n.x || child.y >= n.y || child.z >= n.z) continue;
    Int3 low;
    Int3 high;
    lattice.voxels(child, level, low, high);
    const double weight =
        static_cast<double>(high.x - low.x) * static_cast<double>(high.y - low.y) * static_cast<double>(high.z - low.z);
    mean.add(texels[table_index(child, n)], weight);
  }
  return mean.value();
}

/// Returns texel `i` of a level as look-ups read it: a NaN texel beside finite ones, at a corner too, has their mean. A
/// blend of a finite and a NaN texel is NaN, and half of each finite cube between others would not be seen.
WEIR_HOST_DEVICE inline float texel_beside_finite(const float* texels, const Int3& n, const Int3& i) {
  const float own = texels[table_index(i, n)];
  if (is_finite(own)) return own;
  const Int3 low{greater(i.x - 1, 0), greater(i.y - 1, 0), greater(i.z - 1, 0)};
  const Int3 high{lesser(i.x + 1, n.x - 1), lesser(i.y + 1, n.y - 1), lesser(i.z + 1, n.z - 1)};
  VoxelMean mean;
  for (std::int32_t z = low.z; z <= high.z; ++z) {
    for (std::int32_t y = low.y; y <= high.y; ++y) {
      for (std::int32_t x = low.x; x <= high.x; ++x) mean.add(texels[table_index({x, y, z}, n)], 1.0);
    }
  }
  return mean.value();
}

}  // namespace weir
