// Equidistant levels, and the code of the level that is nearest to a value.
#pragma once

#include "format/base/simd.h"

namespace weir {

/// Adding and then subtracting this number rounds a float below 2^22 to the nearest whole number, ties to even.
inline constexpr float kRounder = 12582912.0F;  // 1.5 * 2^23

/// The levels minimum + code * quantum for codes 0 to `top`. `reciprocal` is 1 / quantum, or 0 if there is one level.
struct CodeLevels {
  float minimum;
  float quantum;
  float reciprocal;
  float top;
};

/// Sets `code` to the code of each value of `v`.
[[gnu::always_inline]] inline void nearest_code(const Floats8& v, const CodeLevels& l, Floats8& code) {
  const Floats8 zero{};
  const Floats8 top = l.top - zero;
  Floats8 t = (v - l.minimum) * l.reciprocal;
  t = t > zero ? t : zero;
  t = t < top ? t : top;
  code = (t + kRounder) - kRounder;
}

}  // namespace weir
