// Light from all around as a latitude-longitude picture, as kernels see it: radiance by direction, and directions
// drawn in proportion to it. Radiance and density are constant within a texel, so that the drawn directions agree
// exactly with `density`.
#pragma once

#include "gpu/math/random.h"
#include "gpu/math/vector3.h"

namespace weir {

/// Probabilities are whole multiples of 1 / kEnvironmentUnit: a random integer below it picks a texel with exactly
/// the tables' probability.
inline constexpr std::uint32_t kEnvironmentUnit = 1U << 31U;

/// Returns the index i of the interval [bounds[i], bounds[i + 1]) that contains `at`, by bisection. `bounds` rises
/// from 0 to kEnvironmentUnit in `count` steps, and at < kEnvironmentUnit. Never returns an empty interval.
WEIR_HOST_DEVICE inline std::int32_t find_interval(const std::uint32_t* bounds, std::int32_t count, std::uint32_t at) {
  std::int32_t low = 0;
  std::int32_t high = count;
  while (high - low > 1) {
    const std::int32_t middle = low + (high - low) / 2;
    if (bounds[middle] <= at) {
      low = middle;
    } else {
      high = middle;
    }
  }
  return low;
}

/// A direction towards the light, its radiance and its probability density per steradian.
struct EnvironmentSample {
  Float3 direction;
  Float3 radiance;
  float density = 0;
};

/// Pointers may be to host or device memory. The picture's first row is around `up` and its centre column at azimuth
/// 0. Azimuth falls to the right, as an observer inside sees it.
struct EnvironmentView {
  const Float3* radiance = nullptr;        ///< height x width, rows from the top; null: no environment
  const std::uint32_t* rows = nullptr;     ///< height + 1 bounds of the rows' probabilities
  const std::uint32_t* columns = nullptr;  ///< height x (width + 1) bounds of the columns' probabilities in each row
  std::int32_t width = 0;                  ///< texels, twice the height
  std::int32_t height = 0;
  Float3 up{0, 0, 1};
  Float3 ahead{1, 0, 0};  ///< azimuth 0
  Float3 left{0, 1, 0};   ///< azimuth 90 degrees
  /// Mean radiance over the cosine-weighted hemisphere around a normal (x ahead, y left, z up) as a
  /// polynomial, factors of 1, y, z, x, xy, yz, 3z^2 - 1, xz, x^2 - y^2. Ramamoorthi and Hanrahan, An
  /// Efficient Representation for Irradiance Environment Maps, SIGGRAPH 2001.
  Float3 harmonics[9];

  WEIR_HOST_DEVICE bool present() const { return radiance != nullptr; }

  /// Returns the radiance from a unit direction: that of its texel.
  WEIR_HOST_DEVICE Float3 at(const Float3& direction) const {
    std::int32_t row;
    std::int32_t column;
    find_texel(direction, row, column);
    return radiance[index(row, column)];
  }

  /// Returns the density, per steradian, with which `sample` draws a unit direction.
  WEIR_HOST_DEVICE float density(const Float3& direction) const {
    std::int32_t row;
    std::int32_t column;
    find_texel(direction, row, column);
    return density(row, column);
  }

  WEIR_HOST_DEVICE EnvironmentSample sample(Random& random) const {
    const std::int32_t row = find_interval(rows, height, random.bits() >> 1U);
    const std::int32_t column = find_interval(columns + column_bounds(row), width, random.bits() >> 1U);
    // Uniform in azimuth and in the cosine of the polar angle t. Uses s = sin^2(t / 2) = (1 - cos t) / 2 from the
    // nearer pole, because 1 - cos t would cancel there.
    const bool lower = 2 * row >= height;
    const auto from_pole = static_cast<float>(lower ? height - 1 - row : row);
    const float quarter = 0.5F * kPi / static_cast<float>(height);  // half a row's height
    const float s0 = std::sin(from_pole * quarter);
    const float s1 = std::sin((from_pole + 1.0F) * quarter);
    const float s = mix(s0 * s0, s1 * s1, random.uniform());
    const float cosine = lower ? 2.0F * s - 1.0F : 1.0F - 2.0F * s;
    const float sine = 2.0F * std::sqrt(s * (1.0F - s));
    const float azimuth =
        kPi - (static_cast<float>(column) + random.uniform()) * (2.0F * kPi / static_cast<float>(width));
    const Float3 local{sine * std::cos(azimuth), sine * std::sin(azimuth), cosine};
    return {ahead * local.x + left * local.y + up * local.z, radiance[index(row, column)], density(row, column)};
  }

  /// Returns the radiance from a unit direction, blended from the four texels around it so that it looks smooth.
  WEIR_HOST_DEVICE Float3 blended(const Float3& direction) const {
    float x;
    float y;
    position(direction, x, y);
    y = clamped(y - 0.5F, 0.0F, static_cast<float>(height - 1));
    x = x < 0.5F ? x - 0.5F + static_cast<float>(width) : x - 0.5F;  // the picture wraps around at its sides
    const std::int32_t x0 = clamped(static_cast<std::int32_t>(x), 0, width - 1);
    const std::int32_t y0 = static_cast<std::int32_t>(y);
    const std::int32_t x1 = x0 + 1 < width ? x0 + 1 : 0;
    const std::int32_t y1 = lesser(y0 + 1, height - 1);
    const float fx = clamped(x - static_cast<float>(x0), 0.0F, 1.0F);
    const Float3 above = mix(radiance[index(y0, x0)], radiance[index(y0, x1)], fx);
    const Float3 below = mix(radiance[index(y1, x0)], radiance[index(y1, x1)], fx);
    return mix(above, below, y - static_cast<float>(y0));
  }

  /// Returns what a matt white surface of unit `normal` reflects. For soft light it is exact to some percent of the
  /// peak; the light of a sun is blurred to about 90 degrees.
  WEIR_HOST_DEVICE Float3 on_surface(const Float3& normal) const {
    const float x = dot(normal, ahead);
    const float y = dot(normal, left);
    const float z = dot(normal, up);
    const Float3 sum = harmonics[0] + harmonics[1] * y + harmonics[2] * z + harmonics[3] * x + harmonics[4] * (x * y) +
                       harmonics[5] * (y * z) + harmonics[6] * (3.0F * z * z - 1.0F) + harmonics[7] * (x * z) +
                       harmonics[8] * (x * x - y * y);
    return {greater(sum.x, 0.0F), greater(sum.y, 0.0F), greater(sum.z, 0.0F)};
  }

  /// Returns the steradians that each texel of a row covers: (cos t0 - cos t1) 2 pi / width, as a product that does
  /// not cancel.
  WEIR_HOST_DEVICE float solid_angle(std::int32_t row) const {
    const float step = kPi / static_cast<float>(height);
    return 4.0F * kPi / static_cast<float>(width) * std::sin((static_cast<float>(row) + 0.5F) * step) *
           std::sin(0.5F * step);
  }

  WEIR_HOST_DEVICE std::int64_t index(std::int32_t row, std::int32_t column) const {
    return static_cast<std::int64_t>(row) * width + column;
  }
  /// Returns where a row's bounds begin in `columns`.
  WEIR_HOST_DEVICE std::int64_t column_bounds(std::int32_t row) const {
    return static_cast<std::int64_t>(row) * (width + 1);
  }

 private:
  // Returns the position in texels from the upper left corner. The polar angle is as precise at the poles as
  // elsewhere.
  WEIR_HOST_DEVICE void position(const Float3& direction, float& x, float& y) const {
    const float a = dot(direction, ahead);
    const float b = dot(direction, left);
    const float polar = std::atan2(std::sqrt(a * a + b * b), dot(direction, up));
    x = (0.5F - std::atan2(b, a) / (2.0F * kPi)) * static_cast<float>(width);
    y = polar / kPi * static_cast<float>(height);
  }
  WEIR_HOST_DEVICE void find_texel(const Float3& direction, std::int32_t& row, std::int32_t& column) const {
    float x;
    float y;
    position(direction, x, y);
    row = clamped(static_cast<std::int32_t>(y), 0, height - 1);
    column = clamped(static_cast<std::int32_t>(x), 0, width - 1);
  }
  WEIR_HOST_DEVICE float density(std::int32_t row, std::int32_t column) const {
    const std::uint32_t* bounds = columns + column_bounds(row) + column;
    constexpr float kShare = 1.0F / static_cast<float>(kEnvironmentUnit);
    return static_cast<float>(rows[row + 1] - rows[row]) * kShare *
           (static_cast<float>(bounds[1] - bounds[0]) * kShare) / solid_angle(row);
  }
};

}  // namespace weir
