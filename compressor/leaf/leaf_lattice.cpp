#include "compressor/leaf/leaf_lattice.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <numeric>

#include "format/base/index.h"
#include "format/base/simd.h"

namespace weir {
namespace {

constexpr std::int32_t kLargestCode = 65535;
/// The unit of the last bit of a smaller value has no reciprocal in float.
constexpr float kSmallest = 0x1p-100F;

// Converts values to whole numbers in units of `1 / scale`. Returns false if a value is no whole number, is -0.0, or is
// so small beside the unit that scaling makes it 0. The scaled values must be below 2^24 in magnitude.
WEIR_SIMD bool to_integers(const float* values, std::size_t count, float scale, std::int32_t* integers) {
  bool whole = true;
  for (std::size_t i = 0; i < count && whole; i += 16) {
    const std::size_t end = i + 16 < count ? i + 16 : count;
    std::uint32_t bad = 0;
    for (std::size_t k = i; k < end; ++k) {
      std::uint32_t bits;
      std::memcpy(&bits, values + k, sizeof bits);
      const float scaled = values[k] * scale;
      const auto integer = static_cast<std::int32_t>(scaled);
      integers[k] = integer;
      bad |= static_cast<float>(integer) != scaled ? 1U : 0U;
      bad |= integer == 0 && bits != 0 ? 1U : 0U;
    }
    whole = bad == 0;
  }
  return whole;
}

}  // namespace

std::optional<LeafLattice> find_lattice(std::span<const float> values, float min, float max) {
  const float magnitude = std::max(std::fabs(min), std::fabs(max));
  if (!(magnitude >= kSmallest && magnitude <= 0x1p100F)) return std::nullopt;
  // The unit is the last bit of the largest magnitude, so that all values are below 2^24 units.
  const int exponent = std::ilogb(magnitude) - 23;
  std::array<std::int32_t, kLeafVoxels> integers;
  const float scale = std::ldexp(1.0F, -exponent);
  if (!to_integers(values.data(), values.size(), scale, integers.data())) return std::nullopt;

  const auto used = std::span(integers).first(values.size());
  const auto lowest = static_cast<std::int32_t>(min * scale);
  const auto highest = static_cast<std::int32_t>(max * scale);
  const std::int32_t range = highest - lowest;
  std::int32_t step = range;
  for (const std::int32_t value : used) {
    const std::int32_t above = value - lowest;
    if (above % step == 0) continue;
    step = std::gcd(step, above);
    if (range / step > kLargestCode) return std::nullopt;
    if (step == 1) break;
  }
  // code * step is a multiple of the largest power of two that divides step. It would round from 2^24 multiples on.
  if (range / (step & -step) >= 1 << 24) return std::nullopt;
  return LeafLattice{std::ldexp(static_cast<float>(step), exponent), static_cast<std::uint32_t>(range / step)};
}

unsigned bits_for(std::uint32_t largest) {
  return std::bit_ceil(static_cast<unsigned>(std::bit_width(std::max(largest, 1U))));
}

}  // namespace weir
