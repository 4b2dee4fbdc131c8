// The inverse of the orthonormal DCT-II of a block, operation by operation (FORMAT.md, "Values of transformed blocks").
// T is float, or a vector of floats for several transforms side by side, with the same bits.
#pragma once

#include "format/base/host_device.h"

namespace weir {

/// cos(n pi / 16) / 2, rounded to the nearest float.
inline constexpr float kCosine[8] = {0.5F,
                                     0.4903926402016152F,
                                     0.46193976625564337F,
                                     0.4157348061512726F,
                                     0.35355339059327379F,
                                     0.2777851165098011F,
                                     0.1913417161825449F,
                                     0.0975451610080641F};

/// Turns the coefficients x[0..7] into their values. Operations must not be fused: compile with -ffp-contract=off,
/// -fmad=false.
template <typename T>
WEIR_HOST_DEVICE inline void inverse_transform_8(T (&x)[8]) {
  constexpr float c1 = kCosine[1], c2 = kCosine[2], c3 = kCosine[3], c4 = kCosine[4], c5 = kCosine[5], c6 = kCosine[6],
                  c7 = kCosine[7];
  const T a0 = c4 * (x[0] + x[4]);
  const T a1 = c4 * (x[0] - x[4]);
  const T a2 = c2 * x[2] + c6 * x[6];
  const T a3 = c6 * x[2] - c2 * x[6];
  const T e0 = a0 + a2;
  const T e3 = a0 - a2;
  const T e1 = a1 + a3;
  const T e2 = a1 - a3;
  const T o0 = c1 * x[1] + c3 * x[3] + c5 * x[5] + c7 * x[7];
  const T o1 = c3 * x[1] - c7 * x[3] - c1 * x[5] - c5 * x[7];
  const T o2 = c5 * x[1] - c1 * x[3] + c7 * x[5] + c3 * x[7];
  const T o3 = c7 * x[1] - c5 * x[3] + c3 * x[5] - c1 * x[7];
  x[0] = e0 + o0;
  x[7] = e0 - o0;
  x[1] = e1 + o1;
  x[6] = e1 - o1;
  x[2] = e2 + o2;
  x[5] = e2 - o2;
  x[3] = e3 + o3;
  x[4] = e3 - o3;
}

}  // namespace weir
