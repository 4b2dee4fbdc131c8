// Positions with as many bits as the texture unit takes. For host and device.
#pragma once

#include <cstdint>

namespace weir {

/// Floats from here to 2^16 have 8 bits below the point: the sum of this and a position, less than 2^14, is a fixed
/// point number, and its bits are kFixedPointBits more than 256 times the position.
inline constexpr float kFixedPoint = 49152;
inline constexpr std::uint32_t kFixedPointBits = 0x47400000U;
inline constexpr std::uint32_t kFixedPointEnd = 1U << 14U;  ///< of positions

}  // namespace weir
