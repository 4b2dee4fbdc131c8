// Masks of eight lanes: all bits of a lane are set if a condition holds for it. A mask is Ints8 for floats and Longs8
// for doubles.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>

#include "format/base/simd.h"

namespace weir {

[[gnu::always_inline]] inline bool any_lane(const Ints8& mask) {
  std::array<std::uint64_t, 4> pairs;
  std::memcpy(pairs.data(), &mask, sizeof mask);
  return (pairs[0] | pairs[1] | pairs[2] | pairs[3]) != 0;
}

}  // namespace weir
