// Positions with as many bits as the texture unit takes. For host and device.
#pragma once

#include <cstdint>

#include "gpu/math/vector3.h"

namespace weir {

/// Floats from here to 2^16 have 8 bits below the point: the sum of this and a position, less than 2^14, is a fixed
/// point number, and its bits are kFixedPointBits more than 256 times the position.
inline constexpr float kFixedPoint = 49152;
inline constexpr std::uint32_t kFixedPointBits = 0x47400000U;
inline constexpr std::uint32_t kFixedPointEnd = 1U << 14U;  ///< of positions

/// A place as fixed point bits: voxels from some block's lowest corner.
struct FixedPlace {
  std::uint32_t x;
  std::uint32_t y;
  std::uint32_t z;

  /// Of local voxels, centres at whole numbers, those outside moved into the domain: `first` is kFixedPoint and the
  /// voxels from that corner to the domain's, `last` the domain's highest voxel.
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
