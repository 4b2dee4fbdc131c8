#include "format/packed/block_encode.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <numeric>

#include "format/base/doubles8.h"
#include "format/base/transpose_lanes.h"
#include "format/packed/block_decode.h"
#include "format/packed/coefficient_values.h"
#include "format/packed/forward_transform.h"

namespace weir {
namespace {

struct BlockRange {
  float low;
  float high;
  double sum;
};

WEIR_SIMD BlockRange range_of(const float* values) {
  Floats8 low;
  std::memcpy(&low, values, sizeof low);
  Floats8 high = low;
  Doubles8 sum{};
  for (unsigned row = 0; row < 64; ++row) {
    Floats8 v;
    std::memcpy(&v, values + 8 * row, sizeof v);
    low = v < low ? v : low;
    high = v > high ? v : high;
    sum += Doubles8(v);
  }
  BlockRange range{low[0], high[0], 0};
  for (int l = 0; l < 8; ++l) {
    range.low = low[l] < range.low ? low[l] : range.low;
    range.high = high[l] > range.high ? high[l] : range.high;
    range.sum += sum[l];
  }
  return range;
}

// The lanes of a vector: one slab of a block, or two consecutive slabs.
struct OneSlab {
  using Lanes = Floats8;
};
struct TwoSlabs {
  using Lanes = Floats16;
};

// Load slabs from `at` on as eight vectors of their rows, or store them.
[[gnu::always_inline]] inline void load_slabs(const float* at, Floats8 (&rows)[8]) {
  for (unsigned i = 0; i < 8; ++i) load_lanes(at + 8 * i, rows[i]);
}
[[gnu::always_inline]] inline void store_slabs(const Floats8 (&rows)[8], float* at) {
  for (unsigned i = 0; i < 8; ++i) store_lanes(rows[i], at + 8 * i);
}
#ifdef WEIR_SIMD_PATHS
[[gnu::always_inline]] inline void load_slabs(const float* at, Floats16 (&rows)[8]) {
  for (unsigned i = 0; i < 8; ++i) {
    Floats8 first;
    Floats8 second;
    load_lanes(at + 8 * i, first);
    load_lanes(at + 64 + 8 * i, second);
    rows[i] = __builtin_shufflevector(first, second, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
  }
}
[[gnu::always_inline]] inline void store_slabs(const Floats16 (&rows)[8], float* at) {
  for (unsigned i = 0; i < 8; ++i) {
    const Floats8 first = __builtin_shufflevector(rows[i], rows[i], 0, 1, 2, 3, 4, 5, 6, 7);
    const Floats8 second = __builtin_shufflevector(rows[i], rows[i], 8, 9, 10, 11, 12, 13, 14, 15);
    store_lanes(first, at + 8 * i);
    store_lanes(second, at + 64 + 8 * i);
  }
}
#endif

// Computes the coefficients of the differences from the mean; coefficient 0, the mean's, becomes 0. Also computes the
// largest magnitude and the sum of squares of each row. Returns the largest magnitude of all.
template <typename Slabs>
[[gnu::always_inline]] inline float transform_slabs(const float* values, float mean, float* coefficients,
                                                    float* row_largest, double* row_energy) {
  using Lanes = typename Slabs::Lanes;
  constexpr unsigned kLanes = sizeof(Lanes) / sizeof(float);
  alignas(64) float turned[512];  // index x << 6 | z << 3 | y, slabs side by side as in a vector
  for (unsigned x = 0; x < 64; x += kLanes) {
    Lanes rows[8];
    load_slabs(values + 8 * x, rows);
    for (Lanes& row : rows) row -= mean;
    forward_transform_8(rows);  // along y
    transpose_8(rows);
    forward_transform_8(rows);  // along z
    store_slabs(rows, turned + 8 * x);
  }
  for (unsigned zy = 0; zy < 64; zy += kLanes) {
    Lanes rows[8];
    for (unsigned x = 0; x < 8; ++x) load_lanes(turned + 64 * x + zy, rows[x]);
    forward_transform_8(rows);  // along x
    for (unsigned x = 0; x < 8; ++x) store_lanes(rows[x], turned + 64 * x + zy);
  }
  turned[0] = 0;
  Floats8 largest{};
  for (unsigned x = 0; x < 8; ++x) {
    Floats8 rows[8];
    load_slabs(turned + 64 * x, rows);  // a lane for each row
    Floats8 most{};
    Doubles8 sum{};
    for (const Floats8& c : rows) {
      const Floats8 size = c < 0 ? -c : c;
      most = size > most ? size : most;
      const Doubles8 wide(c);
      sum += wide * wide;
    }
    store_lanes(most, row_largest + 8 * x);
    store_lanes(sum.low, row_energy + 8 * x);
    store_lanes(sum.high, row_energy + 8 * x + 4);
    largest = most > largest ? most : largest;
    transpose_8(rows);
    store_slabs(rows, coefficients + 64 * x);
  }
  float found = 0;
  for (int l = 0; l < 8; ++l) found = largest[l] > found ? largest[l] : found;
  return found;
}

#ifdef WEIR_SIMD_PATHS
__attribute__((target("avx512f"))) float transform_512(const float* values, float mean, float* coefficients,
                                                       float* row_largest, double* row_energy) {
  return transform_slabs<TwoSlabs>(values, mean, coefficients, row_largest, row_energy);
}
__attribute__((target_clones("avx2", "default"))) float transform_256(const float* values, float mean,
                                                                      float* coefficients, float* row_largest,
                                                                      double* row_energy) {
  return transform_slabs<OneSlab>(values, mean, coefficients, row_largest, row_energy);
}
float transform(const float* values, float mean, float* coefficients, float* row_largest, double* row_energy) {
  static const bool wide = packed_detail::has_avx512();
  return (wide ? transform_512 : transform_256)(values, mean, coefficients, row_largest, row_energy);
}
#else
float transform(const float* values, float mean, float* coefficients, float* row_largest, double* row_energy) {
  return transform_slabs<OneSlab>(values, mean, coefficients, row_largest, row_energy);
}
#endif

// The result of quantise_rows().
struct Quantised {
  double squared_error;
  unsigned last_place;  // the last place that is not zero; 0 if all are zero
};

// Returns a word with bit i set if the largest magnitude of row i is not below `least`.
[[gnu::always_inline]] inline std::uint64_t live_rows(const float* largest, float least) {
  using Bytes8 = std::uint8_t __attribute__((vector_size(8)));
  Ints8 columns{};  // bit i of lane l is of row 8 i + l
  for (unsigned i = 0; i < 8; ++i) {
    Floats8 of_rows;
    load_lanes(largest + 8 * i, of_rows);
    columns |= ~(of_rows < least) & 1 << i;
  }
  const Bytes8 bytes = __builtin_convertvector(columns, Bytes8);
  std::uint64_t bits;
  std::memcpy(&bits, &bytes, sizeof bits);
  // Transposes eight by eight bits: first single bits, then squares of two, then squares of four.
  std::uint64_t swapped = (bits ^ bits >> 7U) & 0x00AA00AA00AA00AAU;
  bits ^= swapped ^ swapped << 7U;
  swapped = (bits ^ bits >> 14U) & 0x0000CCCC0000CCCCU;
  bits ^= swapped ^ swapped << 14U;
  swapped = (bits ^ bits >> 28U) & 0x00000000F0F0F0F0U;
  return bits ^ swapped ^ swapped << 28U;
}

// Quantises at a step, by index. Rows are zero if their largest coefficient is below the dead zone.
WEIR_SIMD Quantised quantise_rows(const float* coefficients, const float* largest, const double* energy, float step,
                                  const std::int32_t* places, MagnitudeRows& magnitudes) {
  const float scale = 1.0F / step;
  const float least = least_of_row(step);
  Floats8 sum{};  // in squared steps, each at most a little above a third
  Ints8 last{};
  const Floats8 none{};
  const Ints8 zero{};
  const std::uint64_t live = live_rows(largest, least);
  magnitudes.live = live;
  // Live rows first, then the others: taking turns would make the branch hard to predict.
  for (std::uint64_t rows = live; rows != 0; rows &= rows - 1) {
    const auto row = static_cast<unsigned>(std::countr_zero(rows));
    Floats8 c;
    load_lanes(coefficients + 8 * row, c);
    const Floats8 size = c < 0 ? -c : c;
    const Floats8 scaled = size * scale;
    Ints8 m = __builtin_convertvector(scaled + kRounding, Ints8);
    m = m < 1 ? zero + 1 : m;
    m = scaled < kDeadZone ? zero : m;
    store_lanes(m, magnitudes.row(row));
    const Floats8 whole = __builtin_convertvector(m, Floats8);
    const Floats8 below = m == 1 ? kBelowOne - none : kBelowMore - none;
    Floats8 decoded = whole - below;
    decoded = m == 0 ? none : decoded;
    const Floats8 error = scaled - decoded;
    sum += error * error;
    Ints8 place;
    load_lanes(places + 8 * row, place);
    place = m == 0 ? zero : place;
    last = place > last ? place : last;
  }
  double dropped = 0;
  for (std::uint64_t rows = ~live; rows != 0; rows &= rows - 1) {
    const auto row = static_cast<unsigned>(std::countr_zero(rows));
    store_lanes(zero, magnitudes.row(row));
    dropped += energy[row];
  }
  double total = 0;
  std::int32_t last_place = 0;
  for (int l = 0; l < 8; ++l) {
    total += static_cast<double>(sum[l]);
    last_place = last[l] > last_place ? last[l] : last_place;
  }
  return {dropped + total * static_cast<double>(step) * static_cast<double>(step), static_cast<unsigned>(last_place)};
}

// Computes the coefficients that magnitudes decode to, with the signs of `signs`.
WEIR_SIMD void decode_rows(const float* signs, const MagnitudeRows& magnitudes, float below_one, float below_more,
                           float step, float* values) {
  const Floats8 none{};
  for (unsigned row = 0; row < 64; ++row) {
    Floats8 decoded{};
    if ((magnitudes.live >> row & 1U) != 0) {
      Ints8 m;
      Floats8 sign;
      std::memcpy(&m, magnitudes.row(row), sizeof m);
      std::memcpy(&sign, signs + 8 * row, sizeof sign);
      const Floats8 below = m == 1 ? below_one - none : below_more - none;
      const Floats8 size = (__builtin_convertvector(m, Floats8) - below) * step;
      decoded = m == 0 ? none : sign < 0 ? -size : size;
    }
    std::memcpy(values + 8 * row, &decoded, sizeof decoded);
  }
}

// Returns the last of the places with the least nonzero magnitude: the one to drop if a stream is too long.
unsigned cheapest_place(const MagnitudeRows& magnitudes) {
  unsigned cheapest = 0;
  std::uint32_t least = ~0U;
  for (unsigned place = 1; place < 512; ++place) {
    const std::uint32_t m = magnitudes.at(kBlockScan.index[place]);
    if (m == 0 || m > least) continue;
    least = m;
    cheapest = place;
  }
  return cheapest;
}

}  // namespace

TransformBlock::TransformBlock(const std::uint16_t* tables)
    : coder_(tables, ValueEncoder::Kind::transform), rows_(symbol_costs(tables)) {}

bool TransformBlock::set(std::span<const float, 512> values) {
  const auto [low, high, sum] = range_of(values.data());
  mean_ = static_cast<float>(sum / 512);
  const float range = high - low;
  if (!(std::fabs(low) < kLargestTransformed && std::fabs(high) < kLargestTransformed)) return false;
  if (range < kLeastTransformed) return false;
  const float largest = transform(values.data(), mean_, coefficients_.data(), row_largest_.data(), row_energy_.data());
  energy_ = std::accumulate(row_energy_.begin(), row_energy_.end(), 0.0);
  largest_ = static_cast<double>(largest);
  return true;
}

TransformBlock::Cost TransformBlock::cost(std::int32_t step) {
  const float size = step_size(step);
  if (largest_ / static_cast<double>(size) > kMostMagnitude) return {kNotCodedBits, 0};
  const Quantised quantised = quantise_rows(coefficients_.data(), row_largest_.data(), row_energy_.data(), size,
                                            kPlacesByIndex.place, magnitudes_);
  Cost cost{8, quantised.squared_error};
  if (quantised.last_place == 0) return cost;
  const unsigned end = end_at(quantised.last_place);
  constexpr unsigned kEndBits = 5;
  constexpr unsigned kLeastMeanBits = 6;
  cost.bits = 8 + rows_.of(magnitudes_, end).stream_bits(end, kEndBits, kLeastMeanBits);
  return cost;
}

void TransformBlock::encode(const BlockConstants& constants, const MeanRange& range, std::int32_t step,
                            std::span<std::byte> out) {
  const Quantised quantised = quantise_rows(coefficients_.data(), row_largest_.data(), row_energy_.data(),
                                            step_size(step), kPlacesByIndex.place, magnitudes_);
  std::array<std::uint32_t, 512> signs;
  std::memcpy(signs.data(), coefficients_.data(), sizeof signs);
  StreamFront& front = front_;
  front.number_bits = mean_bits(range, step);
  front.number = mean_code(range, step, mean_);
  const auto head = [&](PackedKind kind) {
    return static_cast<std::byte>(static_cast<unsigned>(kind) | static_cast<unsigned>(step - constants.coarsest) << 2U);
  };
  front.end = end_at(quantised.last_place);
  dropped_ = false;
  while (front.end > 0) {
    out[0] = head(PackedKind::transform);
    if (coder_.encode(front, {magnitudes_, signs}, out.subspan(1))) return;
    const unsigned cheapest = kBlockScan.index[cheapest_place(magnitudes_)];
    magnitudes_.row(cheapest / 8)[cheapest % 8] = 0;
    dropped_ = true;
    front.end = end_of(magnitudes_);
  }
  std::fill(out.begin(), out.end(), std::byte{0});
  out[0] = head(PackedKind::mean);
  for (unsigned i = 0; i < front.number_bits && 1 + i / 8 < out.size(); ++i) {
    if ((front.number >> i & 1U) != 0) out[1 + i / 8] |= static_cast<std::byte>(1U << (i % 8));
  }
}

bool TransformBlock::decoded(const BlockConstants& constants, const MeanRange& range, std::int32_t step,
                             std::span<float, 512> values) const {
  if (front_.end == 0) return false;
  decode_rows(coefficients_.data(), magnitudes_, constants.below_one, constants.below_more, step_size(step),
              values.data());
  const auto last_row = 63U - static_cast<unsigned>(std::countl_zero(magnitudes_.live));
  values_of_coefficients(constants, decode_mean(range, step, front_.number), last_row / 8 + 1, values.data());
  return true;
}

}  // namespace weir
