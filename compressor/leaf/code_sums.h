// What values come to that are assigned to the levels of a quantiser.
#pragma once

#include "format/base/simd.h"

namespace weir {

/// Added and taken away again, it rounds a float below 2^22 to the nearest whole number, ties to even.
inline constexpr float kRounder = 12582912.0F;  // 1.5 * 2^23

// What one assignment of values to levels comes to. Deviations are from the leaf's mean, times a power of two that
// brings them near 1, so that neither 1e-16 nor 1e+30 squared leaves the range of float.
struct CodeSums {
  double squares = 0;  // of the errors of the scaled deviations
  double codes = 0;    // exact: below 2^24 a lane for up to 8 bits
  double code_squares = 0;
  double code_values = 0;  // code * deviation
};

struct CodeLevels {
  float minimum;
  float quantum;
  float reciprocal;
  float top;
};

// The code of each value.
template <typename Floats>
[[gnu::always_inline]] inline void nearest(const Floats& v, const CodeLevels& l, Floats& code) {
  const Floats zero{};
  const Floats top = l.top - zero;
  Floats t = (v - l.minimum) * l.reciprocal;
  t = t > zero ? t : zero;
  t = t < top ? t : top;
  code = (t + kRounder) - kRounder;
}

}  // namespace weir
