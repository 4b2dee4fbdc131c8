// Eight doubles, one for each lane of Floats8 or Ints8, as two vectors of four. GCC keeps every intermediate result of
// a vector wider than its registers in memory, which takes several times as long. Operators work lane by lane.
// Functions return a vector of eight through a reference parameter, because a returned one has a different ABI for each
// instruction set.
#pragma once

#include <cstddef>
#include <cstdint>

#include "format/base/simd.h"

namespace weir {

/// A mask for each lane of Doubles8: all bits set where a condition holds, none elsewhere.
struct Longs8 {
  using Longs4 = std::int64_t __attribute__((vector_size(32)));
  Longs4 low;   ///< lanes 0 to 3
  Longs4 high;  ///< lanes 4 to 7
};

struct Doubles8 {
  using Doubles4 = double __attribute__((vector_size(32)));
  Doubles4 low;   ///< lanes 0 to 3
  Doubles4 high;  ///< lanes 4 to 7

  Doubles8() = default;
  /// Sets all lanes to `value`.
  [[gnu::always_inline]] inline Doubles8(double value) : low(value - Doubles4{}), high(value - Doubles4{}) {}
  [[gnu::always_inline]] inline explicit Doubles8(const Floats8& v)
      : low(__builtin_convertvector(__builtin_shufflevector(v, v, 0, 1, 2, 3), Doubles4)),
        high(__builtin_convertvector(__builtin_shufflevector(v, v, 4, 5, 6, 7), Doubles4)) {}
  [[gnu::always_inline]] inline explicit Doubles8(const Ints8& v)
      : low(__builtin_convertvector(__builtin_shufflevector(v, v, 0, 1, 2, 3), Doubles4)),
        high(__builtin_convertvector(__builtin_shufflevector(v, v, 4, 5, 6, 7), Doubles4)) {}

  double operator[](std::size_t lane) const { return lane < 4 ? low[lane] : high[lane - 4]; }

  [[gnu::always_inline]] inline Doubles8& operator+=(const Doubles8& b) {
    low += b.low;
    high += b.high;
    return *this;
  }
  [[gnu::always_inline]] inline Doubles8& operator-=(const Doubles8& b) {
    low -= b.low;
    high -= b.high;
    return *this;
  }
  [[gnu::always_inline]] inline Doubles8& operator*=(const Doubles8& b) {
    low *= b.low;
    high *= b.high;
    return *this;
  }
  [[gnu::always_inline]] inline Doubles8& operator/=(const Doubles8& b) {
    low /= b.low;
    high /= b.high;
    return *this;
  }

  [[gnu::always_inline]] friend inline Doubles8 operator-(Doubles8 a) {
    a.low = -a.low;
    a.high = -a.high;
    return a;
  }
  [[gnu::always_inline]] friend inline Doubles8 operator+(Doubles8 a, const Doubles8& b) { return a += b; }
  [[gnu::always_inline]] friend inline Doubles8 operator-(Doubles8 a, const Doubles8& b) { return a -= b; }
  [[gnu::always_inline]] friend inline Doubles8 operator*(Doubles8 a, const Doubles8& b) { return a *= b; }
  [[gnu::always_inline]] friend inline Doubles8 operator/(Doubles8 a, const Doubles8& b) { return a /= b; }
  [[gnu::always_inline]] friend inline Longs8 operator<(const Doubles8& a, const Doubles8& b) {
    return {a.low < b.low, a.high < b.high};
  }
  [[gnu::always_inline]] friend inline Longs8 operator>(const Doubles8& a, const Doubles8& b) { return b < a; }
  [[gnu::always_inline]] friend inline Longs8 operator>=(const Doubles8& a, const Doubles8& b) {
    return {a.low >= b.low, a.high >= b.high};
  }
};

[[gnu::always_inline]] inline Longs8 operator&(const Longs8& a, const Longs8& b) {
  return {a.low & b.low, a.high & b.high};
}
[[gnu::always_inline]] inline Longs8 operator~(const Longs8& a) { return {~a.low, ~a.high}; }

/// Returns `a` in the lanes where the mask is set, `b` in the others.
[[gnu::always_inline]] inline Doubles8 select(const Longs8& mask, Doubles8 a, const Doubles8& b) {
  a.low = mask.low ? a.low : b.low;
  a.high = mask.high ? a.high : b.high;
  return a;
}

/// Rounds the lanes to floats.
[[gnu::always_inline]] inline void narrow(const Doubles8& v, Floats8& floats) {
  using Floats4 = float __attribute__((vector_size(16)));
  floats = __builtin_shufflevector(__builtin_convertvector(v.low, Floats4), __builtin_convertvector(v.high, Floats4), 0,
                                   1, 2, 3, 4, 5, 6, 7);
}
/// Rounds the lanes towards zero.
[[gnu::always_inline]] inline void narrow(const Doubles8& v, Ints8& ints) {
  using Ints4 = std::int32_t __attribute__((vector_size(16)));
  ints = __builtin_shufflevector(__builtin_convertvector(v.low, Ints4), __builtin_convertvector(v.high, Ints4), 0, 1, 2,
                                 3, 4, 5, 6, 7);
}
/// Takes the low half of each lane: turns a mask for doubles into the same mask for Floats8.
[[gnu::always_inline]] inline void narrow(const Longs8& v, Ints8& ints) {
  using Ints4 = std::int32_t __attribute__((vector_size(16)));
  ints = __builtin_shufflevector(__builtin_convertvector(v.low, Ints4), __builtin_convertvector(v.high, Ints4), 0, 1, 2,
                                 3, 4, 5, 6, 7);
}
/// Turns a mask of Ints8 into the same mask for doubles.
[[gnu::always_inline]] inline Longs8 widen(const Ints8& mask) {
  return {__builtin_convertvector(__builtin_shufflevector(mask, mask, 0, 1, 2, 3), Longs8::Longs4),
          __builtin_convertvector(__builtin_shufflevector(mask, mask, 4, 5, 6, 7), Longs8::Longs4)};
}

}  // namespace weir
