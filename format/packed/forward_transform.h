// The orthonormal DCT-II of a block, operation by operation: the transpose of inverse_transform.h. T is float, or a
// vector of floats for several transforms side by side, with the same bits. For host and device.
#pragma once

#include "format/base/host_device.h"
#include "format/packed/inverse_transform.h"

// Vector code must be inlined into functions that are compiled for its width.
#if defined(__CUDACC__)
#define WEIR_ALWAYS_INLINE
#else
#define WEIR_ALWAYS_INLINE [[gnu::always_inline]]
#endif

namespace weir {

/// Turns the values x[0..7] into their coefficients. Operations must not be fused: compile with -ffp-contract=off,
/// -fmad=false.
template <typename T>
WEIR_ALWAYS_INLINE WEIR_HOST_DEVICE inline void forward_transform_8(T (&x)[8]) {
  constexpr float c1 = kCosine[1], c2 = kCosine[2], c3 = kCosine[3], c4 = kCosine[4], c5 = kCosine[5], c6 = kCosine[6],
                  c7 = kCosine[7];
  const T s0 = x[0] + x[7], s1 = x[1] + x[6], s2 = x[2] + x[5], s3 = x[3] + x[4];
  const T d0 = x[0] - x[7], d1 = x[1] - x[6], d2 = x[2] - x[5], d3 = x[3] - x[4];
  const T e0 = s0 + s3, e1 = s1 + s2, f0 = s0 - s3, f1 = s1 - s2;
  x[0] = c4 * (e0 + e1);
  x[4] = c4 * (e0 - e1);
  x[2] = c2 * f0 + c6 * f1;
  x[6] = c6 * f0 - c2 * f1;
  x[1] = c1 * d0 + c3 * d1 + c5 * d2 + c7 * d3;
  x[3] = c3 * d0 - c7 * d1 - c1 * d2 - c5 * d3;
  x[5] = c5 * d0 - c1 * d1 + c7 * d2 + c3 * d3;
  x[7] = c7 * d0 - c5 * d1 + c3 * d2 - c1 * d3;
}

}  // namespace weir

#undef WEIR_ALWAYS_INLINE
