// Scalar arithmetic that host and device code share.
#pragma once

#include <cmath>
#include <cstdint>

#include "format/base/host_device.h"

namespace weir {

inline constexpr float kInfinity = __builtin_huge_valf();
inline constexpr float kPi = 3.14159265358979323846F;

template <class T>
WEIR_HOST_DEVICE constexpr T lesser(T a, T b) {
  return b < a ? b : a;
}
template <class T>
WEIR_HOST_DEVICE constexpr T greater(T a, T b) {
  return a < b ? b : a;
}
/// Returns `v` moved into [lo, hi]; NaN becomes lo.
template <class T>
WEIR_HOST_DEVICE constexpr T clamped(T v, T lo, T hi) {
  return v > lo ? (v < hi ? v : hi) : lo;
}

/// Returns a b + c, rounded twice. Compilers may not fuse it into one operation, so the result is the same in every
/// kernel.
WEIR_HOST_DEVICE inline float multiply_add(float a, float b, float c) {
#if defined(__CUDA_ARCH__)
  return __fadd_rn(__fmul_rn(a, b), c);
#else
  return a * b + c;
#endif
}

/// Returns false for NaN and both infinities.
WEIR_HOST_DEVICE inline bool is_finite(float v) { return v - v == 0.0F; }

/// Returns (1 - t) a + t b. Unlike a + t (b - a), it does not overflow for finite a and b of any sign.
WEIR_HOST_DEVICE inline float mix(float a, float b, float t) { return (1.0F - t) * a + t * b; }

}  // namespace weir
