#include "format/packed/row_costs.h"

#include <algorithm>

#include "format/base/simd.h"

namespace weir {
namespace {

constexpr unsigned kStride = MagnitudeRows::kStride;
constexpr auto kFirstEscape = static_cast<std::int32_t>(kEscape);
constexpr std::int32_t kNoCost = kPackedBands * kPackedLevels * kPackedSymbols;

struct LaneSums {
  std::int32_t symbols[8];
  std::int32_t raw[8];
  std::int32_t zero[8];  // minus the magnitudes that are not
};

// floor(log2(v)) of 1 to 2^24.
[[gnu::always_inline]] inline void log2_of(const Ints8& v, Ints8& log2) {
  const Floats8 f = __builtin_convertvector(v, Floats8);
  __builtin_memcpy(&log2, &f, sizeof log2);
  log2 = (log2 >> 23) - 127;
}

// BlockScan::level of sums of neighbours: floor(3 log2(1 + 2 t / 3)), at most the last.
[[gnu::always_inline]] inline void level_of(const Ints8& t, Ints8& level) {
  const Floats8 u = __builtin_convertvector(3 + 2 * t, Floats8) / 3.0F;
  Ints8 bits;
  __builtin_memcpy(&bits, &u, sizeof bits);
  const Ints8 mantissa = bits & 0x7FFFFF;
  constexpr std::int32_t kThird = 0x214518;      // 2^(1/3)
  constexpr std::int32_t kTwoThirds = 0x4B2FF5;  // 2^(2/3)
  level = 3 * ((bits >> 23) - 127) - (mantissa >= kThird) - (mantissa >= kTwoThirds);
  constexpr auto kLast = static_cast<std::int32_t>(kPackedLevels - 1);
  level = level < kLast ? level : kLast - Ints8{};
}

[[gnu::always_inline]] inline void load_row(const std::int32_t* at, Ints8& row) {
  __builtin_memcpy(&row, at, sizeof row);
}

// Bit i set: row i has one that is not zero, or its neighbours have.
std::uint64_t busy_rows(std::uint64_t live) {
  constexpr std::uint64_t kFirstOfEight = 0x0101010101010101U;
  return live | live << 8U | (live << 1U & ~kFirstOfEight);
}

// All places but the first four, and only those below `limit`.
WEIR_SIMD void add_rows(const RowCosts::Tables& tables, const std::int32_t* padded, std::uint64_t busy,
                        std::int32_t limit, LaneSums& sums) {
  const Ints8 none{};
  Ints8 symbols{};
  Ints8 raw{};
  Ints8 zero{};
  for (unsigned row = 0; row < 64; ++row) {
    if (tables.first_place[row] >= limit) continue;
    Ints8 place;
    load_row(tables.place + 8 * row, place);
    const Ints8 coded = place < limit;  // all bits where it is
    if ((busy >> row & 1U) == 0) {
      Ints8 cost;
      load_row(tables.zero_cost + 8 * row, cost);
      symbols += cost & coded;
      continue;
    }
    const std::int32_t* at = padded + kStride * (row + 8) + 8;
    Ints8 m, up, left{}, back, weight, first_cost;
    load_row(at, m);
    load_row(at - 8 * kStride, up);
    if (row % 8 != 0) load_row(at - kStride, left);  // of j = 0 the row before is of another i
    load_row(at - 1, back);
    load_row(tables.weight + 8 * row, weight);
    load_row(tables.first_cost + 8 * row, first_cost);
    const Ints8 t = (up + left + back) * weight;
    Ints8 extra;
    log2_of(t > 36 ? t / 18 : none + 1, extra);
    extra = extra > 16 ? none + 16 : extra;
    const Ints8 high = m >> extra;
    const Ints8 escaped = high >= kFirstEscape;
    const Ints8 symbol = escaped ? none + kFirstEscape : high;
    Ints8 level;
    level_of(t, level);
    const Ints8 entry = coded ? first_cost + 16 * level + symbol : none + kNoCost;
    alignas(32) std::int32_t entries[8];
    __builtin_memcpy(entries, &entry, sizeof entries);
    Ints8 cost;
    for (int l = 0; l < 8; ++l) cost[l] = tables.cost[entries[l]];
    symbols += cost;
    Ints8 escape;
    log2_of(escaped ? high - (kFirstEscape - 1) : none + 1, escape);
    raw += (extra + ((escape + 5) & escaped)) & coded;
    zero += (m != 0) & coded;
  }
  for (int l = 0; l < 8; ++l) {
    sums.symbols[l] = symbols[l];
    sums.raw[l] = raw[l];
    sums.zero[l] = zero[l];
  }
}

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
  LaneSums sums;
  add_rows(tables_, magnitudes.padded, busy_rows(magnitudes.live), static_cast<std::int32_t>(kEndUnit * end), sums);
  for (int l = 0; l < 8; ++l) {
    sum.symbols += static_cast<std::uint32_t>(sums.symbols[l]);
    sum.raw += static_cast<std::uint32_t>(sums.raw[l]);
    sum.nonzero -= static_cast<std::uint32_t>(sums.zero[l]);
  }
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
