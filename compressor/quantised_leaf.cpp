#include "compressor/quantised_leaf.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <span>

#include "compressor/leaf_lattice.h"
#include "format/leaf_decode.h"

namespace weir {
namespace {

// Calls visit(i) for every in-domain voxel of a leaf, in leaf order.
template <typename Visit>
void for_each_inside(const Box& node, const Box& inside, const Visit& visit) {
  const Index3 lo = inside.lo - node.lo;
  const Index3 hi = inside.hi - node.lo;
  for (std::int64_t x = lo.x; x < hi.x; ++x) {
    for (std::int64_t y = lo.y; y < hi.y; ++y) {
      for (std::int64_t z = lo.z; z < hi.z; ++z) visit(static_cast<std::size_t>(x << 6 | y << 3 | z));
    }
  }
}

// Gives voxels outside the domain the code of the nearest one inside: every layer of the leaf then stays within the
// bounds of its part inside, which the macrocells that reach into it know.
void extend_outside(const Box& node, const Box& inside, std::array<std::uint16_t, kLeafVoxels>& codes) {
  const Index3 lo = inside.lo - node.lo;
  const Index3 last = inside.hi - node.lo - Index3{1, 1, 1};
  for_each_inside(node, node, [&](std::size_t i) {
    const auto at = static_cast<std::int64_t>(i);
    const Index3 nearest = max(lo, min(last, Index3{at >> 6, at >> 3 & 7, at & 7}));
    codes[i] = codes[static_cast<std::size_t>(nearest.x << 6 | nearest.y << 3 | nearest.z)];
  });
}

Quantiser choose_quantiser(std::span<const float> values, unsigned bits) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  ValueRange range{*low, *high, 0};
  // One value, which fl(0 * quantum) + min gives back for -0.0 too where the zero added has its sign.
  if (!(range.min < range.max)) return {range.min, std::copysign(0.0F, range.min)};
  if (const auto lattice = find_lattice(values, range.min, range.max); lattice && bits_for(lattice->largest) <= bits) {
    return {range.min, lattice->step};
  }
  double sum = 0;
  for (const float v : values) sum += static_cast<double>(v);
  range.mean = static_cast<float>(sum / static_cast<double>(values.size()));
  return fit_quantiser(values, range, bits).quantiser;
}

float rounded_up(double value) {
  const auto rounded = static_cast<float>(value);
  return static_cast<double>(rounded) < value ? std::nextafter(rounded, std::numeric_limits<float>::infinity())
                                              : rounded;
}

}  // namespace

QuantisedLeaf quantise_leaf(const LeafValues& values, const LeafValues& source, const Box& node, const Box& inside,
                            unsigned bits_log2) {
  QuantisedLeaf leaf;
  leaf.bits_log2 = bits_log2;
  const unsigned bits = 1U << bits_log2;
  LeafValues compact;
  std::size_t count = 0;
  for_each_inside(node, inside, [&](std::size_t i) { compact[count++] = values[i]; });
  const auto seen = std::span<const float>(compact).first(count);
  leaf.quantiser = choose_quantiser(seen, bits);
  std::array<std::uint16_t, kLeafVoxels> codes;
  quantise(seen, leaf.quantiser, bits, std::span(codes).first(count));

  count = 0;
  for_each_inside(node, inside, [&](std::size_t i) { leaf.codes[i] = codes[count++]; });
  if (inside != node) extend_outside(node, inside, leaf.codes);
  for (std::size_t i = 0; i < kLeafVoxels; ++i) {
    leaf.decoded[i] = dequantize(leaf.codes[i], leaf.quantiser.quantum, leaf.quantiser.minimum);
  }

  double worst = 0;
  for_each_inside(node, inside, [&](std::size_t i) {
    leaf.exact = leaf.exact && std::bit_cast<std::uint32_t>(leaf.decoded[i]) == std::bit_cast<std::uint32_t>(values[i]);
    if (!std::isfinite(source[i])) return;
    const double error = static_cast<double>(source[i]) - static_cast<double>(leaf.decoded[i]);
    leaf.squared_error += error * error;
    worst = std::max(worst, std::fabs(error));
  });
  leaf.max_abs = rounded_up(worst);
  return leaf;
}

}  // namespace weir
