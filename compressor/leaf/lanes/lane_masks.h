// Which of eight lanes something holds of, all bits of a lane set: beside floats as Ints8, beside doubles as Longs8.
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
