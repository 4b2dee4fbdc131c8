#include "gpu/image/flip_color.h"

#include <array>
#include <cmath>

namespace weir {

namespace {

using Matrix = std::array<std::array<double, 3>, 3>;

// XYZ of linear sRGB (IEC 61966-2-1), with each row divided by its sum so that white is (1, 1, 1). No illuminant is
// then needed below.
constexpr Matrix kRelativeXyz{{{10135552.0 / 23359437, 8788810.0 / 23359437, 4435075.0 / 23359437},
                               {2613072.0 / 12288897, 8788810.0 / 12288897, 887015.0 / 12288897},
                               {1425312.0 / 80288307, 8788810.0 / 80288307, 70074185.0 / 80288307}}};

constexpr Matrix inverse(const Matrix& m) {
  const auto minor = [&](std::size_t r, std::size_t c) {
    const std::size_t r1 = (r + 1) % 3;
    const std::size_t r2 = (r + 2) % 3;
    const std::size_t c1 = (c + 1) % 3;
    const std::size_t c2 = (c + 2) % 3;
    return m[r1][c1] * m[r2][c2] - m[r1][c2] * m[r2][c1];
  };
  const double determinant = m[0][0] * minor(0, 0) + m[0][1] * minor(0, 1) + m[0][2] * minor(0, 2);
  Matrix result{};
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t c = 0; c < 3; ++c) result[r][c] = minor(c, r) / determinant;
  }
  return result;
}

constexpr Matrix kLinearRgb = inverse(kRelativeXyz);

Float3 product(const Matrix& m, const Float3& v) {
  const auto row = [&](std::size_t r) {
    return static_cast<float>(m[r][0]) * v.x + static_cast<float>(m[r][1]) * v.y + static_cast<float>(m[r][2]) * v.z;
  };
  return {row(0), row(1), row(2)};
}

// The cube root; near black, the line that continues it (CIE 15:2004).
float lightness_response(float t) {
  constexpr float kDelta = 6.0F / 29;
  return t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3 * kDelta * kDelta) + 4.0F / 29;
}

}  // namespace

Float3 opponent_from_linear(const Float3& rgb) {
  const Float3 xyz = product(kRelativeXyz, rgb);
  return {116 * xyz.y - 16, 500 * (xyz.x - xyz.y), 200 * (xyz.y - xyz.z)};
}

Float3 linear_from_opponent(const Float3& opponent) {
  const float y = (opponent.x + 16) / 116;
  return product(kLinearRgb, {y + opponent.y / 500, y, y - opponent.z / 200});
}

Float3 hunt_lab(const Float3& rgb) {
  const Float3 xyz = product(kRelativeXyz, rgb);
  const float x = lightness_response(xyz.x);
  const float y = lightness_response(xyz.y);
  const float z = lightness_response(xyz.z);
  const float lightness = 116 * y - 16;
  return {lightness, 0.01F * lightness * 500 * (x - y), 0.01F * lightness * 200 * (y - z)};
}

float hyab_difference(const Float3& a, const Float3& b) {
  const Float3 d = a - b;
  return std::pow(std::abs(d.x) + std::sqrt(d.y * d.y + d.z * d.z), 0.7F);
}

float redistributed(float difference) {
  constexpr float kShare = 0.4F;
  constexpr float kTo = 0.95F;
  static const float largest = hyab_difference(hunt_lab({0, 1, 0}), hunt_lab({0, 0, 1}));
  const float bend = kShare * largest;
  if (difference < bend) return kTo / bend * difference;
  return kTo + (difference - bend) / (largest - bend) * (1 - kTo);
}

}  // namespace weir
