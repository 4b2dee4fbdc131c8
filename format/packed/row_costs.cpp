#include "format/packed/row_costs.h"

#include <algorithm>
#include <array>

#include "format/base/simd.h"
#include "format/packed/stream_length.h"

#ifdef WEIR_SIMD_PATHS
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"  // GCC 12 warns of the header's own undefined lanes
#pragma GCC diagnostic ignored "-Wuninitialized"
#include <immintrin.h>
#pragma GCC diagnostic pop
#endif

namespace weir {
namespace {

using packed_detail::Before;
using packed_detail::kFirstEscape;
using packed_detail::load_neighbours;
using packed_detail::OneRow;
using packed_detail::set_lanes;
using packed_detail::TwoRows;

constexpr std::int32_t kNoCost = kPackedBands * kPackedLevels * kPackedSymbols;

struct Sums {
  std::int32_t symbols = 0;
  std::int32_t raw = 0;
  std::int32_t nonzero = 0;
};

// Returns a word with bit i set if row i or one of its neighbours is not zero.
std::uint64_t busy_rows(std::uint64_t live) {
  constexpr std::uint64_t kFirstOfEight = 0x0101010101010101U;
  return live | live << 8U | (live << 1U & ~kFirstOfEight);
}

// Returns the sum of the costs at the first `count` pairs of entries.
[[gnu::always_inline]] inline std::int32_t costs_of(const RowCosts::Tables& tables,
                                                    const std::array<std::uint64_t, 512 / 2>& entries, unsigned count) {
  // Without this barrier each lane is extracted from its register, which takes longer.
  asm volatile("" : : "r"(entries.data()) : "memory");
  std::int32_t even = 0;
  std::int32_t odd = 0;
  for (unsigned first = 0; first < count; first += 4) {
    for (unsigned i = first; i < first + 4; ++i) {
      even += tables.cost[entries[i] & 0xFFFFFFFFU];
      odd += tables.cost[entries[i] >> 32U];
    }
  }
  return even + odd;
}

// Adds the costs of all places except the first four, and only of those below `limit`. Looks the costs up at the end,
// so that no look-up waits for its lane.
template <typename Lanes>
[[gnu::always_inline]] inline void add_lanes(const RowCosts::Tables& tables, const std::int32_t* padded,
                                             std::uint64_t busy, std::int32_t limit, Sums& sums) {
  using Ints = typename Lanes::Ints;
  constexpr unsigned kLanes = sizeof(Ints) / sizeof(std::int32_t);
  constexpr unsigned kRows = kLanes / 8;
  const RowPlaces& places = *tables.places;
  const Before<Lanes> before;
  const packed_detail::Contexts<Lanes> contexts;
  Ints first_escape, last_plain, one, five, no_cost, limits;
  set_lanes(kFirstEscape, first_escape);
  set_lanes(kFirstEscape - 1, last_plain);
  set_lanes(1, one);
  set_lanes(5, five);
  set_lanes(kNoCost, no_cost);
  set_lanes(limit, limits);
  Ints symbols{};
  Ints raw{};
  Ints nonzero{};
  alignas(64) std::array<std::uint64_t, 512 / 2> entries;
  unsigned count = 0;
  for (unsigned row = 0; row < 64; row += kRows) {
    if (places.first_place[row] >= limit && places.first_place[row + kRows - 1] >= limit) continue;
    Ints place;
    load_lanes(places.place + 8 * row, place);
    const Ints coded = (place - limits) >> 31;  // all bits set if the place is coded
    if ((busy >> row & ((1U << kRows) - 1U)) == 0) {
      Ints cost;
      load_lanes(tables.zero_cost + 8 * row, cost);
      symbols += cost & coded;
      continue;
    }
    const std::int32_t* at = padded + 8 * (row + 8);
    Ints m, up, left, back, weight, first_symbol;
    load_lanes(at, m);
    load_neighbours<Lanes>(at, row, before, up, left, back);
    load_lanes(places.weight + 8 * row, weight);
    load_lanes(places.first_symbol + 8 * row, first_symbol);
    const Ints t = (up + left + back) * weight;
    Ints level;
    Ints extra;
    contexts.find(t, level, extra);
    const Ints high = m >> extra;
    const Ints symbol = high < first_escape ? high : first_escape;
    const Ints entry = ((first_symbol + 16 * level + symbol) & coded) | (no_cost & ~coded);
    store_lanes(entry, entries.data() + count);
    count += kLanes / 2;
    const Ints escaped = (last_plain - high) >> 31;
    Ints escape;
    contexts.log2_of(one + ((high - first_escape) & escaped), escape);
    raw += (extra + ((escape + five) & escaped)) & coded;
    nonzero -= (-m >> 31) & coded;
  }
  for (unsigned l = 0; l < kLanes; ++l) {
    sums.symbols += symbols[l];
    sums.raw += raw[l];
    sums.nonzero += nonzero[l];
  }
  sums.symbols += costs_of(tables, entries, count);
}

#ifdef WEIR_SIMD_PATHS
// Returns the same number in all lanes of a register, and keeps it in that register.
[[gnu::target("avx512f")]] __m512i in_lanes(int value) {
  __m512i lanes = _mm512_set1_epi32(value);
  asm("" : "+v"(lanes));
  return lanes;
}
[[gnu::target("avx512f")]] __m512 in_lanes(float value) {
  __m512 lanes = _mm512_set1_ps(value);
  asm("" : "+v"(lanes));
  return lanes;
}

// add_lanes() for two rows at a time, with AVX-512 masks.
[[gnu::target("avx512f")]] void add_rows_512(const RowCosts::Tables& tables, const std::int32_t* padded,
                                             std::uint64_t busy, std::int32_t limit, Sums& sums) {
  constexpr int kBias = 127;                 // bias of a float's exponent
  constexpr int kSymbolMask = kFirstEscape;  // the low bits of an entry
  static_assert(kPackedSymbols == 16 && (kSymbolMask & (kSymbolMask + 1)) == 0);
  constexpr int kToLevel = 23 - 4;  // moves an exponent above the symbol
  constexpr int kLevelBias = kBias * static_cast<int>(kPackedSymbols);
  const __m512i limits = in_lanes(limit);
  const __m512i level_bias = in_lanes(kLevelBias);
  const __m512i no_cost = in_lanes(kNoCost);
  const __m512i one = in_lanes(1);
  const __m512i first_escape = in_lanes(kFirstEscape);
  const __m512i last_plain = in_lanes(kFirstEscape - 1);
  const __m512i last_level =
      in_lanes((static_cast<int>(kPackedLevels) - 1) * static_cast<int>(kPackedSymbols) + kLevelBias + kSymbolMask);
  const __m512i level_mask = in_lanes(~kSymbolMask);
  const __m512i most_extra = in_lanes(16 + kBias);
  const __m512i no_extra = in_lanes(36);
  const __m512i bias = in_lanes(kBias);
  const __m512i escape_bias = in_lanes(kBias - 5);
  const __m512 two_thirds = in_lanes(2.0F / 3);
  const __m512 whole = in_lanes(1.0F);
  const __m512 eighteenth = in_lanes(1.0F / 18);
  const RowPlaces& places = *tables.places;
  alignas(64) std::array<std::uint64_t, 512 / 2> entries;
  unsigned count = 0;
  __m512i symbols = _mm512_setzero_si512();
  __m512i raw = _mm512_setzero_si512();
  __m512i nonzero = _mm512_setzero_si512();
  for (unsigned row = 0; row < 64; row += 2) {
    if (places.first_place[row] >= limit && places.first_place[row + 1] >= limit) continue;
    const __mmask16 coded = _mm512_cmplt_epi32_mask(_mm512_load_si512(places.place + 8 * row), limits);
    if ((busy >> row & 3U) == 0) {
      symbols = _mm512_mask_add_epi32(symbols, coded, symbols, _mm512_load_si512(tables.zero_cost + 8 * row));
      continue;
    }
    const std::int32_t* at = padded + 8 * (row + 8);
    const __m512i m = _mm512_load_si512(at);
    const __m512i up = _mm512_load_si512(at - 64);
    // For j = 0 the row before belongs to another i.
    const __m512i left = _mm512_maskz_loadu_epi32(static_cast<__mmask16>(row % 8 == 0 ? 0xFF00 : 0xFFFF), at - 8);
    const __m512i back = _mm512_maskz_loadu_epi32(0xFEFE, at - 1);
    const __m512i sum = _mm512_add_epi32(_mm512_add_epi32(up, left), back);
    const __m512i t = _mm512_mullo_epi32(sum, _mm512_load_si512(places.weight + 8 * row));
    // Computes the same as Contexts::find().
    const __m512 real = _mm512_cvtepi32_ps(t);
    const __m512 base = _mm512_add_ps(_mm512_mul_ps(real, two_thirds), whole);
    const __m512i cube = _mm512_castps_si512(_mm512_mul_ps(_mm512_mul_ps(base, base), base));
    const __m512i level = _mm512_min_epi32(_mm512_srli_epi32(cube, kToLevel), last_level);
    const __m512i log2 = _mm512_srli_epi32(_mm512_castps_si512(_mm512_mul_ps(real, eighteenth)), 23);
    const __m512i extra =
        _mm512_maskz_sub_epi32(_mm512_cmpgt_epi32_mask(t, no_extra), _mm512_min_epi32(log2, most_extra), bias);
    const __m512i high = _mm512_srlv_epi32(m, extra);
    constexpr int kFirstAndSecondOrThird = 0xEA;
    const __m512i symbol =
        _mm512_ternarylogic_epi32(level, level_mask, _mm512_min_epi32(high, first_escape), kFirstAndSecondOrThird);
    const __m512i first_symbol = _mm512_sub_epi32(_mm512_load_si512(places.first_symbol + 8 * row), level_bias);
    _mm512_store_si512(entries.data() + count, _mm512_mask_add_epi32(no_cost, coded, first_symbol, symbol));
    count += 8;
    const __mmask16 escaped = _mm512_mask_cmpgt_epi32_mask(coded, high, last_plain);
    const __m512 over = _mm512_cvtepi32_ps(_mm512_sub_epi32(high, last_plain));
    const __m512i escape = _mm512_sub_epi32(_mm512_srli_epi32(_mm512_castps_si512(over), 23), escape_bias);
    raw = _mm512_mask_add_epi32(raw, coded, raw, extra);
    raw = _mm512_mask_add_epi32(raw, escaped, raw, escape);
    nonzero = _mm512_mask_add_epi32(nonzero, _mm512_mask_test_epi32_mask(coded, m, m), nonzero, one);
  }
  sums.symbols += costs_of(tables, entries, count) + _mm512_reduce_add_epi32(symbols);
  sums.raw += _mm512_reduce_add_epi32(raw);
  sums.nonzero += _mm512_reduce_add_epi32(nonzero);
}

__attribute__((target_clones("avx2", "default"))) void add_rows_256(const RowCosts::Tables& tables,
                                                                    const std::int32_t* padded, std::uint64_t busy,
                                                                    std::int32_t limit, Sums& sums) {
  add_lanes<OneRow>(tables, padded, busy, limit, sums);
}

void add_rows(const RowCosts::Tables& tables, const std::int32_t* padded, std::uint64_t busy, std::int32_t limit,
              Sums& sums) {
  static const bool wide = packed_detail::has_avx512();
  (wide ? add_rows_512 : add_rows_256)(tables, padded, busy, limit, sums);
}
#else
void add_rows(const RowCosts::Tables& tables, const std::int32_t* padded, std::uint64_t busy, std::int32_t limit,
              Sums& sums) {
  add_lanes<OneRow>(tables, padded, busy, limit, sums);
}
#endif

}  // namespace

RowCosts::RowCosts(const SymbolCosts& costs, Contexts contexts) {
  const bool bands = contexts == Contexts::transform;
  tables_.places = &row_places(bands);
  const unsigned first_context = bands ? 0 : kPackedBands * kPackedLevels;
  for (unsigned context = 0; context < (bands ? kPackedBands : 1) * kPackedLevels; ++context) {
    std::copy(costs[first_context + context].begin(), costs[first_context + context].end(),
              tables_.cost + kPackedSymbols * context);
  }
  tables_.cost[kNoCost] = 0;
  for (unsigned index = 0; index < 512; ++index) {
    tables_.zero_cost[index] = tables_.cost[tables_.places->first_symbol[index]];
  }
}

RowCosts::Sum RowCosts::of(const MagnitudeRows& magnitudes, unsigned end) const {
  const BlockScan& scan = kBlockScan;
  Sum sum;
  Sums sums;
  add_rows(tables_, magnitudes.padded, busy_rows(magnitudes.live), static_cast<std::int32_t>(kEndUnit * end), sums);
  sum.symbols += static_cast<std::uint32_t>(sums.symbols);
  sum.raw += static_cast<std::uint32_t>(sums.raw);
  sum.nonzero += static_cast<std::uint32_t>(sums.nonzero);
  std::uint32_t before = 0;
  for (unsigned place = 1; place < 4; ++place) {
    const unsigned index = scan.index[place];
    const std::uint32_t m = magnitudes.at(index);
    sum.nonzero += m != 0 ? 1 : 0;
    const std::uint32_t t = scan.weight[place] * before;
    const unsigned level = t < kLevelSums ? scan.level[t] : kPackedLevels - 1;
    const unsigned extra = extra_bits(t);
    const std::uint32_t high = m >> extra;
    const unsigned symbol = kPackedSymbols * level + std::min(high, kEscape);
    sum.symbols +=
        static_cast<std::uint32_t>(tables_.cost[static_cast<unsigned>(tables_.places->first_symbol[index]) + symbol]);
    sum.raw += extra + (high >= kEscape ? escape_bits(high) : 0);
    before += m;
  }
  return sum;
}

std::uint32_t RowCosts::Sum::stream_bits(unsigned end, unsigned end_bits, unsigned number_bits) const {
  return coded_stream_bits(symbols, raw, nonzero, end, end_bits, number_bits);
}

}  // namespace weir
