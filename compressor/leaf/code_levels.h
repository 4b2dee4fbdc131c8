// Equidistant levels, and the code of the one that is nearest to a value.
#pragma once

#include "format/base/simd.h"

namespace weir {

/// Added and taken away again, it rounds a float below 2^22 to the nearest whole number, ties to even.
inline constexpr float kRounder = 12582912.0F;  // 1.5 * 2^23

/// Levels minimum + code * quantum, for codes of 0 to `top`; a reciprocal of 0 where there is one level.
struct CodeLevels {
  float minimum;
  float quantum;
  float reciprocal;
  float top;
};

/// Sets the code of each value.
[[gnu::always_inline]] inline void nearest_code(const Floats8& v, const CodeLevels& l, Floats8& code) {
  const Floats8 zero{};
  const Floats8 top = l.top - zero;
  Floats8 t = (v - l.minimum) * l.reciprocal;
  t = t > zero ? t : zero;
  t = t < top ? t : top;
  code = (t + kRounder) - kRounder;
}

}  // namespace weir
