#include "compressor/leaf/quantised_leaf.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <span>

#include "compressor/leaf/inside_voxels.h"
#include "compressor/leaf/leaf_difference.h"
#include "compressor/leaf/leaf_lattice.h"
#include "compressor/leaf/leaf_summary.h"
#include "format/base/doubles8.h"

namespace weir {
namespace {

// Chooses the quantiser of a leaf. `distinct` are the values without repeats.
Quantiser choose_quantiser(std::span<const float> values, std::span<const float> distinct, unsigned bits, Fit fit,
                           const LeafRepeats& repeats) {
  const ValueRange range = leaf_range(values, repeats);
  // All values are equal. fl(0 * quantum) + min gives this value; for -0.0 the quantum must have the sign of the value.
  if (!(range.min < range.max)) return {values.front(), std::copysign(0.0F, values.front()), 0};
  if (const auto lattice = find_lattice(distinct, range.min, range.max);
      lattice && bits_for(lattice->largest) <= bits) {
    return {range.min, lattice->step, lattice->largest};
  }
  return fit == Fit::largest ? range_quantiser(range, bits) : fit_quantiser(values, range, bits, repeats);
}

WEIR_SIMD void decode(const std::uint16_t* codes, std::size_t count, const Quantiser& quantiser, float* decoded) {
  const Quantiser q = quantiser;
  for (std::size_t i = 0; i < count; ++i) {
    const float product = static_cast<float>(codes[i]) * q.quantum;  // as dequantize(), which no clone could inline
    decoded[i] = product + q.minimum;
  }
}

// Quantises and decodes a leaf that lies in the domain.
void quantise_whole(const LeafValues& values, Fit fit, const LeafRepeats& repeats, QuantisedLeaf& leaf) {
  const unsigned bits = 1U << leaf.bits_log2;
  if (!repeats.pairs_of_rows()) {
    leaf.quantiser = choose_quantiser(values, values, bits, fit, repeats);
    quantise(values, leaf.quantiser, leaf.codes);
    decode(leaf.codes.data(), kLeafVoxels, leaf.quantiser, leaf.decoded.data());
    return;
  }
  LeafValues room;
  std::array<std::uint16_t, kLeafVoxels> codes;
  const std::size_t count = take_distinct(values.data(), repeats.groups, room.data());
  const auto distinct = std::span<const float>(room).first(count);
  leaf.quantiser = choose_quantiser(values, distinct, bits, fit, repeats);
  quantise(distinct, leaf.quantiser, std::span(codes).first(count));
  decode(codes.data(), count, leaf.quantiser, room.data());
  repeat_groups(repeats.groups, codes.data(), leaf.codes.data());
  repeat_groups(repeats.groups, room.data(), leaf.decoded.data());
}

// Quantises and decodes the in-domain values of a leaf that reaches outside.
void quantise_part(const LeafValues& values, const Box& node, const Box& inside, Fit fit, QuantisedLeaf& leaf) {
  LeafValues compact;
  std::size_t count = 0;
  for_each_inside(node, inside, [&](std::size_t i) { compact[count++] = values[i]; });
  const auto seen = std::span<const float>(compact).first(count);
  const unsigned bits = 1U << leaf.bits_log2;
  leaf.quantiser = choose_quantiser(seen, seen, bits, fit, {});
  std::array<std::uint16_t, kLeafVoxels> codes;
  quantise(seen, leaf.quantiser, std::span(codes).first(count));
  count = 0;
  for_each_inside(node, inside, [&](std::size_t i) { leaf.codes[i] = codes[count++]; });
  extend_outside(node, inside, leaf.codes);  // stays within the bounds in the macrocells that reach into the leaf
  decode(leaf.codes.data(), kLeafVoxels, leaf.quantiser, leaf.decoded.data());
}

// Measures the error and the exactness of a leaf of finite values, in the same lanes as difference_of(). If a value is
// not finite, the squared error becomes non-finite.
WEIR_SIMD void measure_lanes(const float* source, const float* decoded, std::array<Doubles8, 2>& squares,
                             std::array<Doubles8, 2>& largest, std::uint32_t& differ, std::uint32_t& zeros_lost) {
  std::array<Doubles8, 2> sum{};
  std::array<Doubles8, 2> most{};
  Ints8 bits{};
  Ints8 lost{};
  const Floats8 zero{};
  for (std::size_t i = 0; i < kLeafVoxels; i += 16) {
    for (std::size_t half = 0; half < 2; ++half) {
      Floats8 s;
      Floats8 d;
      std::memcpy(&s, source + i + 8 * half, sizeof s);
      std::memcpy(&d, decoded + i + 8 * half, sizeof d);
      const Doubles8 error = Doubles8(s) - Doubles8(d);
      const Doubles8 magnitude = select(error < 0.0, -error, error);
      sum[half] += error * error;
      most[half] = select(magnitude > most[half], magnitude, most[half]);
      Ints8 s_bits;
      Ints8 d_bits;
      std::memcpy(&s_bits, &s, sizeof s);
      std::memcpy(&d_bits, &d, sizeof d);
      bits |= s_bits ^ d_bits;
      lost -= (s == zero) & (d != zero);
    }
  }
  squares = sum;
  largest = most;
  differ = 0;
  zeros_lost = 0;
  for (int l = 0; l < 8; ++l) {
    differ |= static_cast<std::uint32_t>(bits[l]);
    zeros_lost += static_cast<std::uint32_t>(lost[l]);
  }
}

void measure(const LeafValues& source, QuantisedLeaf& leaf) {
  std::array<Doubles8, 2> squares;
  std::array<Doubles8, 2> largest;
  std::uint32_t differ = 0;
  measure_lanes(source.data(), leaf.decoded.data(), squares, largest, differ, leaf.zeros_lost);
  std::array<double, 16> lanes;
  std::memcpy(lanes.data(), squares.data(), sizeof lanes);
  for (std::size_t half = 8; half > 0; half /= 2) {
    for (std::size_t l = 0; l < half; ++l) lanes[l] += lanes[l + half];
  }
  leaf.squared_error = lanes[0];
  std::memcpy(lanes.data(), largest.data(), sizeof lanes);
  leaf.max_abs = *std::max_element(lanes.begin(), lanes.end());
  leaf.kept = differ == 0 ? Kept::all : Kept::lossy;
}

}  // namespace

QuantisedLeaf quantise_leaf(const LeafValues& values, const LeafValues& source, const Box& node, const Box& inside,
                            unsigned bits_log2, Fit fit, const LeafRepeats& repeats) {
  QuantisedLeaf leaf;
  leaf.bits_log2 = bits_log2;
  const bool whole = inside == node;
  if (whole) {
    quantise_whole(values, fit, repeats, leaf);
  } else {
    quantise_part(values, node, inside, fit, leaf);
  }

  LeafValues part;
  if (!whole) part = inside_only(source, leaf.decoded, node, inside);
  const LeafValues& seen = whole ? source : part;
  measure(seen, leaf);
  if (std::isfinite(leaf.squared_error)) return leaf;
  // Some source voxels are not finite. They count in no error and must decode to the value that replaced them.
  const LeafDifference lost = difference_of(seen, leaf.decoded);
  leaf.squared_error = lost.squared_error;
  leaf.max_abs = lost.max_abs;
  const LeafDifference of_all =
      difference_of(whole ? values : inside_only(values, leaf.decoded, node, inside), leaf.decoded);
  leaf.kept = kept_of(lost.different == 0, of_all.different == 0);
  return leaf;
}

}  // namespace weir
