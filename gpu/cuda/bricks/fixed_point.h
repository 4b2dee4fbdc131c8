// Positions with as many bits as the texture unit uses. For host and device.
#pragma once

#include <cstdint>

#include "gpu/math/vector3.h"

namespace weir {

/// Floats from kFixedPoint to 2^16 have 8 bits below the point. The sum of kFixedPoint and a position less than 2^14
/// is therefore a fixed point number: its bits are kFixedPointBits plus 256 times the position.
inline constexpr float kFixedPoint = 49152;
inline constexpr std::uint32_t kFixedPointBits = 0x47400000U;
inline constexpr std::uint32_t kFixedPointEnd = 1U << 14U;  ///< end of the positions

/// A place as fixed point bits: voxels from the lowest corner of some block.
struct FixedPlace {
  std::uint32_t x;
  std::uint32_t y;
  std::uint32_t z;

  /// `q` are local voxel coordinates with centres at whole numbers; points outside are moved into the domain. `first`
  /// is kFixedPoint plus the voxels from that corner to the domain's corner. `last` is the domain's highest voxel.
  WEIR_HOST_DEVICE FixedPlace(const Float3& q, const Float3& first, const Float3& last)
      : x(bits(clamped(q.x, 0.0F, last.x) + first.x)),
        y(bits(clamped(q.y, 0.0F, last.y) + first.y)),
        z(bits(clamped(q.z, 0.0F, last.z) + first.z)) {}

 private:
  WEIR_HOST_DEVICE static std::uint32_t bits(float v) {
    std::uint32_t b;
    __builtin_memcpy(&b, &v, sizeof b);
    return b;
  }
};

}  // namespace weir
