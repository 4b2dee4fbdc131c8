// Three floats as position, direction or linear RGB, and three integers as a voxel or cell index. For host and
// device.
#pragma once

#include "gpu/math/portable.h"

namespace weir {

struct Float3 {
  float x = 0;
  float y = 0;
  float z = 0;

  friend constexpr bool operator==(const Float3&, const Float3&) = default;
};

struct Int3 {
  std::int32_t x = 0;
  std::int32_t y = 0;
  std::int32_t z = 0;

  friend constexpr bool operator==(const Int3&, const Int3&) = default;
};

/// Returns the position of `i`, 0 <= i < count, in a table of count.x * count.y * count.z entries (at most 2^31), x
/// fastest.
WEIR_HOST_DEVICE inline std::uint32_t table_index(const Int3& i, const Int3& count) {
  const auto wide = [](std::int32_t n) { return static_cast<std::uint32_t>(n); };
  return wide(i.x) + wide(count.x) * (wide(i.y) + wide(count.y) * wide(i.z));
}

WEIR_HOST_DEVICE constexpr Float3 operator+(const Float3& a, const Float3& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
WEIR_HOST_DEVICE constexpr Float3 operator-(const Float3& a, const Float3& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
WEIR_HOST_DEVICE constexpr Float3 operator-(const Float3& a) { return {-a.x, -a.y, -a.z}; }
WEIR_HOST_DEVICE constexpr Float3 operator*(const Float3& a, const Float3& b) {
  return {a.x * b.x, a.y * b.y, a.z * b.z};
}
WEIR_HOST_DEVICE constexpr Float3 operator*(const Float3& a, float s) { return {a.x * s, a.y * s, a.z * s}; }
WEIR_HOST_DEVICE constexpr Float3 operator/(const Float3& a, const Float3& b) {
  return {a.x / b.x, a.y / b.y, a.z / b.z};
}
WEIR_HOST_DEVICE constexpr Float3& operator+=(Float3& a, const Float3& b) { return a = a + b; }

WEIR_HOST_DEVICE constexpr float dot(const Float3& a, const Float3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
WEIR_HOST_DEVICE constexpr Float3 cross(const Float3& a, const Float3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
WEIR_HOST_DEVICE inline float length(const Float3& a) { return std::sqrt(dot(a, a)); }
WEIR_HOST_DEVICE constexpr float max_component(const Float3& a) { return greater(a.x, greater(a.y, a.z)); }
/// Returns `a` scaled to length 1, or `fallback` if `a` is zero or not finite.
WEIR_HOST_DEVICE inline Float3 normalised(const Float3& a, const Float3& fallback) {
  const float l = length(a);
  if (l > 1e-15F && l < 1e15F) return a * (1.0F / l);
  // The squares of the remaining values leave the range of floats.
  const float largest = max_component({std::abs(a.x), std::abs(a.y), std::abs(a.z)});
  const Float3 scaled = a / Float3{largest, largest, largest};
  const float s = length(scaled);
  return s > 0.0F && is_finite(s) ? scaled * (1.0F / s) : fallback;
}
WEIR_HOST_DEVICE inline Float3 mix(const Float3& a, const Float3& b, float t) { return a * (1.0F - t) + b * t; }

/// Sets two unit vectors that complete unit `n` to a right-handed orthonormal frame.
/// Duff et al., Building an Orthonormal Basis, Revisited, JCGT 6(1), 2017.
WEIR_HOST_DEVICE inline void frame(const Float3& n, Float3& u, Float3& v) {
  const float sign = n.z < 0.0F ? -1.0F : 1.0F;
  const float a = -1.0F / (sign + n.z);
  const float b = n.x * n.y * a;
  u = {1.0F + sign * n.x * n.x * a, sign * b, -sign * n.x};
  v = {b, sign + n.y * n.y * a, -n.y};
}

}  // namespace weir
