#include "format/packed/row_costs.h"

#include <algorithm>

#include "format/base/simd.h"

namespace weir {
namespace {

constexpr auto kFirstEscape = static_cast<std::int32_t>(kEscape);
constexpr std::int32_t kNoCost = kPackedBands * kPackedLevels * kPackedSymbols;

struct Sums {
  std::int32_t symbols = 0;
  std::int32_t raw = 0;
  std::int32_t nonzero = 0;
};

// Lanes of one row, or of two that follow each other. Each path has the width that its instructions have: compilers
// take wider lanes apart.
struct OneRow {
  using Ints = Ints8;
  using Floats = Floats8;
};
struct TwoRows {
  using Ints = Ints16;
  using Floats = Floats16;
};

// A difference shifted by 31 has all bits where it is negative; comparisons of that many lanes are slow.

// Those of a float: 2^exponent * (1 + mantissa / 2^23).
template <typename Lanes>
[[gnu::always_inline]] inline void split(const typename Lanes::Ints& v, typename Lanes::Ints& exponent,
                                         typename Lanes::Ints& mantissa) {
  const auto f = __builtin_convertvector(v, typename Lanes::Floats);
  typename Lanes::Ints bits;
  __builtin_memcpy(&bits, &f, sizeof bits);
  exponent = (bits >> 23) - 127;
  mantissa = bits & 0x7FFFFF;
}

// BlockScan::level of sums of neighbours: floor(3 log2(1 + 2 t / 3)), at most the last; of v = 3 + 2 t its thresholds
// are 3 * 2^(n / 3).
template <typename Lanes>
[[gnu::always_inline]] inline void level_of(const typename Lanes::Ints& t, typename Lanes::Ints& level) {
  typename Lanes::Ints exponent;
  typename Lanes::Ints mantissa;
  split<Lanes>(3 + 2 * t, exponent, mantissa);
  constexpr std::int32_t kTwoThirds = 0x1863F8;  // of 1.5 * 2^(2/3) / 2
  constexpr std::int32_t kWhole = 0x400000;      // of 1.5
  constexpr std::int32_t kThird = 0x71E7A4;      // of 1.5 * 2^(1/3)
  level =
      3 * exponent - 2 + ((mantissa - kTwoThirds) >> 31) + ((mantissa - kWhole) >> 31) + ((mantissa - kThird) >> 31);
  constexpr auto kLast = static_cast<std::int32_t>(kPackedLevels - 1);
  const typename Lanes::Ints none{};
  level = level < kLast ? level : none + kLast;
}

// extra_bits() of sums of neighbours: floor(log2(t / 18)) of more than 36, at most 16.
template <typename Lanes>
[[gnu::always_inline]] inline void extra_of(const typename Lanes::Ints& t, typename Lanes::Ints& extra) {
  typename Lanes::Ints exponent;
  typename Lanes::Ints mantissa;
  split<Lanes>(t, exponent, mantissa);
  extra = exponent - 4 + ((mantissa - 0x100000) >> 31);  // 18 is 1.125 * 2^4
  const typename Lanes::Ints none{};
  extra = extra < 16 ? extra : none + 16;
  extra &= (36 - t) >> 31;
}

template <typename Ints>
[[gnu::always_inline]] inline void load_lanes(const std::int32_t* at, Ints& lanes) {
  __builtin_memcpy(&lanes, at, sizeof lanes);
}

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
  const Ints none{};
  Ints not_first{};
  Ints second_row{};
  for (unsigned l = 0; l < kLanes; ++l) {
    not_first[l] = l % 8 == 0 ? 0 : -1;
    second_row[l] = l < 8 ? 0 : -1;
  }
  Ints symbols{};
  Ints raw{};
  Ints nonzero{};
  std::int32_t looked_up = 0;
  for (unsigned row = 0; row < 64; row += kRows) {
    if (tables.first_place[row] >= limit && tables.first_place[row + kRows - 1] >= limit) continue;
    Ints place;
    load_lanes(tables.place + 8 * row, place);
    const Ints coded = (place - limit) >> 31;  // all bits where it is
    if ((busy >> row & ((1U << kRows) - 1U)) == 0) {
      Ints cost;
      load_lanes(tables.zero_cost + 8 * row, cost);
      symbols += cost & coded;
      continue;
    }
    const std::int32_t* at = padded + 8 * (row + 8);
    Ints m, up, left, back, weight, first_cost;
    load_lanes(at, m);
    load_lanes(at - 64, up);
    load_lanes(at - 8, left);
    if (row % 8 == 0) left &= second_row;  // of j = 0 the row before is of another i
    load_lanes(at - 1, back);
    back &= not_first;
    load_lanes(tables.weight + 8 * row, weight);
    load_lanes(tables.first_cost + 8 * row, first_cost);
    const Ints t = (up + left + back) * weight;
    Ints extra;
    extra_of<Lanes>(t, extra);
    const Ints high = m >> extra;
    const Ints escaped = (kFirstEscape - 1 - high) >> 31;
    const Ints symbol = high < kFirstEscape ? high : none + kFirstEscape;
    Ints level;
    level_of<Lanes>(t, level);
    const Ints entry = ((first_cost + 16 * level + symbol) & coded) | (kNoCost & ~coded);
    alignas(64) std::int32_t entries[kLanes];
    __builtin_memcpy(entries, &entry, sizeof entries);
    asm volatile("" : "+m"(entries));  // else each lane is taken out of its register, which takes longer
    for (const std::int32_t e : entries) looked_up += tables.cost[e];
    Ints escape;
    Ints unused;
    split<Lanes>(1 + ((high - kFirstEscape) & escaped), escape, unused);
    raw += (extra + ((escape + 5) & escaped)) & coded;
    nonzero -= (-m >> 31) & coded;
  }
  for (unsigned l = 0; l < kLanes; ++l) {
    sums.symbols += symbols[l];
    sums.raw += raw[l];
    sums.nonzero += nonzero[l];
  }
  sums.symbols += looked_up;
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

const bool has_512 = __builtin_cpu_supports("avx512f") != 0;

void add_rows(const RowCosts::Tables& tables, const std::int32_t* padded, std::uint64_t busy, std::int32_t limit,
              Sums& sums) {
  (has_512 ? add_rows_512 : add_rows_256)(tables, padded, busy, limit, sums);
}
#else
void add_rows(const RowCosts::Tables& tables, const std::int32_t* padded, std::uint64_t busy, std::int32_t limit,
              Sums& sums) {
  add_lanes<OneRow>(tables, padded, busy, limit, sums);
}
#endif

}  // namespace

RowCosts::RowCosts(const SymbolCosts& costs, Contexts contexts) {
  const BlockScan& scan = kBlockScan;
  const bool bands = contexts == Contexts::transform;
  const unsigned first_context = bands ? 0 : kPackedBands * kPackedLevels;
  for (unsigned context = 0; context < (bands ? kPackedBands : 1) * kPackedLevels; ++context) {
    std::copy(costs[first_context + context].begin(), costs[first_context + context].end(),
              tables_.cost + kPackedSymbols * context);
  }
  tables_.cost[kNoCost] = 0;
  std::fill(std::begin(tables_.first_place), std::end(tables_.first_place), 512);
  for (unsigned place = 0; place < 512; ++place) {
    const unsigned index = scan.index[place];
    // The first four are counted one by one: place 0 is not coded, the others look at each other.
    const bool first = place < 4;
    tables_.weight[index] = scan.weight[place];
    tables_.place[index] = first ? 512 : static_cast<std::int32_t>(place);
    tables_.first_cost[index] =
        static_cast<std::int32_t>((bands ? scan.band[place] : 0U) * kPackedLevels * kPackedSymbols);
    tables_.zero_cost[index] = tables_.cost[tables_.first_cost[index]];
    std::int32_t& least = tables_.first_place[index / 8];
    least = std::min(least, tables_.place[index]);
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
    sum.symbols += static_cast<std::uint32_t>(tables_.cost[static_cast<unsigned>(tables_.first_cost[index]) + symbol]);
    sum.raw += extra + (high >= kEscape ? escape_bits(high) : 0);
    before += m;
  }
  return sum;
}

std::uint32_t RowCosts::Sum::stream_bits(unsigned end, unsigned end_bits, unsigned number_bits) const {
  const unsigned states = states_of(end);
  // Each state begins at 16 bits, which hold signs and the number's low bits, and ends in whole bytes of 3 or more.
  // A state begins with 16 to 17 bits, and whole numbers in it lose a little of each symbol.
  std::uint32_t coded = symbols + 256 * (raw + 17 * states);
  coded += coded / 1024;
  const std::uint32_t back = std::max(3 * states, (coded + 2047) / 2048 + (states - 1));
  const auto spare = static_cast<std::int32_t>(nonzero) - static_cast<std::int32_t>(16 * states);
  const std::int32_t front =
      static_cast<std::int32_t>(end_bits + states) + std::max(spare, -static_cast<std::int32_t>(number_bits));
  return static_cast<std::uint32_t>(front + static_cast<std::int32_t>(8 * back));
}

}  // namespace weir
