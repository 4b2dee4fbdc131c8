#include "format/packed/row_costs.h"

#include <algorithm>

#include "format/base/simd.h"
#include "format/packed/stream_length.h"

namespace weir {
namespace {

using packed_detail::Before;
using packed_detail::kFirstEscape;
using packed_detail::load_lanes;
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

// Bit i set: row i has one that is not zero, or its neighbours have.
std::uint64_t busy_rows(std::uint64_t live) {
  constexpr std::uint64_t kFirstOfEight = 0x0101010101010101U;
  return live | live << 8U | (live << 1U & ~kFirstOfEight);
}

// All places but the first four, and only those below `limit`.
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
  std::int32_t even = 0;
  std::int32_t odd = 0;
  for (unsigned row = 0; row < 64; row += kRows) {
    if (places.first_place[row] >= limit && places.first_place[row + kRows - 1] >= limit) continue;
    Ints place;
    load_lanes(places.place + 8 * row, place);
    const Ints coded = (place - limits) >> 31;  // all bits where it is
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
    Ints extra;
    contexts.extra_of(t, extra);
    const Ints high = m >> extra;
    const Ints symbol = high < first_escape ? high : first_escape;
    Ints level;
    contexts.level_of(t, level);
    const Ints entry = ((first_symbol + 16 * level + symbol) & coded) | (no_cost & ~coded);
    alignas(64) std::uint64_t entries[kLanes / 2];
    __builtin_memcpy(entries, &entry, sizeof entries);
    asm volatile("" : "+m"(entries));  // else each lane is taken out of its register, which takes longer
    for (const std::uint64_t two : entries) {
      even += tables.cost[two & 0xFFFFFFFFU];
      odd += tables.cost[two >> 32U];
    }
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
  sums.symbols += even + odd;
}

#ifdef WEIR_SIMD_PATHS
__attribute__((target("avx512f"))) void add_rows_512(const RowCosts::Tables& tables, const std::int32_t* padded,
                                                     std::uint64_t busy, std::int32_t limit, Sums& sums) {
  add_lanes<TwoRows>(tables, padded, busy, limit, sums);
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
