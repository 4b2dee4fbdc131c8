#include "compressor/leaf/lanes/lane_sums.h"

#include <array>

namespace weir {
namespace {

constexpr std::size_t kRowPairs = kLeafDim / 2;

// Sums the terms of a leaf with X groups along x, Y along y and `z_groups` along z.
template <std::size_t X, std::size_t Y, typename Lanes>
[[gnu::always_inline]] inline void sum_shape(const Lanes* terms, std::size_t z_groups, Lanes& total) {
  std::array<Lanes, X> sums{};
  const std::size_t planes = kLeafDim / z_groups;
  for (std::size_t z = 0; z < z_groups; ++z, terms += X * Y) {
    std::array<Lanes, X * Y> plane;
#pragma GCC unroll 16
    for (std::size_t i = 0; i < X * Y; ++i) plane[i] = terms[i];
    for (std::size_t n = 0; n < planes; ++n) {
#pragma GCC unroll 4
      for (std::size_t pair = 0; pair < kRowPairs; ++pair) {
#pragma GCC unroll 4
        for (std::size_t x = 0; x < X; ++x) sums[x] += plane[pair * Y / kRowPairs * X + x];
      }
    }
  }
  // Adds both rows of a pair, then the lanes of a row; lanes that lie far apart come first.
#pragma GCC unroll 4
  for (std::size_t x = 0; x < X; ++x) sums[x] += sums[x];
  if constexpr (X == 4) {
    sums[0] += sums[2];
    sums[1] += sums[3];
  }
  if constexpr (X == 2 || X == 4) sums[0] += sums[1];
#pragma GCC unroll 4
  for (std::size_t equal = X; equal < kLeafDim; equal *= 2) sums[0] += sums[0];
  total = sums[0];
}

template <std::size_t X, typename Lanes>
[[gnu::always_inline]] inline void sum_rows(const Lanes* terms, const LaneShape& shape, Lanes& total) {
  if (shape.y == 4) return sum_shape<X, 4>(terms, shape.z, total);
  if (shape.y == 2) return sum_shape<X, 2>(terms, shape.z, total);
  sum_shape<X, 1>(terms, shape.z, total);
}

template <typename Lanes>
[[gnu::always_inline]] inline void sum_all(const Lanes* terms, const LaneShape& shape, Lanes& total) {
  if (shape.x == 4) return sum_rows<4>(terms, shape, total);
  if (shape.x == 2) return sum_rows<2>(terms, shape, total);
  sum_rows<1>(terms, shape, total);
}

}  // namespace

WEIR_SIMD void sum_groups(const Floats8* terms, const LaneShape& shape, Floats8& total) {
  sum_all(terms, shape, total);
}

WEIR_SIMD void sum_groups(const Doubles8* terms, const LaneShape& shape, Doubles8& total) {
  sum_all(terms, shape, total);
}

}  // namespace weir
