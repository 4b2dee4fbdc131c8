#include "format/packed/row_costs.h"

#include <algorithm>

#include "format/base/simd.h"

namespace weir {
namespace {

constexpr std::int32_t kLastLevelSum = 511;
constexpr unsigned kStride = MagnitudeRows::kStride;

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

[[gnu::always_inline]] inline void load_row(const std::int32_t* at, Ints8& row) {
  __builtin_memcpy(&row, at, sizeof row);
}

// All places but the first four, and only those below `limit`.
WEIR_SIMD void add_rows(const RowCosts::Tables& tables, const std::int32_t* padded, std::int32_t limit,
                        LaneSums& sums) {
  const Ints8 none{};
  Ints8 symbols{};
  Ints8 raw{};
  Ints8 zero{};
  for (unsigned row = 0; row < 64; ++row) {
    if (tables.first_place[row] >= limit) continue;
    const std::int32_t* at = padded + kStride * (row + 8) + 8;
    Ints8 m, up, left{}, back, weight, place, context;
    load_row(at, m);
    load_row(at - 8 * kStride, up);
    if (row % 8 != 0) load_row(at - kStride, left);  // of j = 0 the row before is of another i
    load_row(at - 1, back);
    load_row(tables.weight + 8 * row, weight);
    load_row(tables.place + 8 * row, place);
    load_row(tables.context + 8 * row, context);
    const Ints8 t = (up + left + back) * weight;
    Ints8 extra;
    log2_of(t > 36 ? t / 18 : none + 1, extra);
    extra = extra > 16 ? none + 16 : extra;
    const Ints8 high = m >> extra;
    const Ints8 symbol = high < 15 ? high : none + 15;
    const Ints8 counted = t < kLastLevelSum ? t : none + kLastLevelSum;
    Ints8 cost;
    for (int l = 0; l < 8; ++l) cost[l] = tables.cost[16 * (context[l] + tables.level[counted[l]]) + symbol[l]];
    Ints8 escape;
    log2_of(high < 15 ? none + 1 : high - 14, escape);
    escape = high < 15 ? none : escape + 5;
    const Ints8 coded = place < limit;  // all bits where it is
    symbols += cost & coded;
    raw += (extra + escape) & coded;
    zero += (m != 0) & coded;
  }
  for (int l = 0; l < 8; ++l) {
    sums.symbols[l] = symbols[l];
    sums.raw[l] = raw[l];
    sums.zero[l] = zero[l];
  }
}

}  // namespace

RowCosts::RowCosts(const SymbolCosts& costs) {
  const BlockScan& scan = kBlockScan;
  for (unsigned context = 0; context < kPackedBands * kPackedLevels; ++context) {
    std::copy(costs[context].begin(), costs[context].end(), tables_.cost + kPackedSymbols * context);
  }
  for (unsigned t = 0; t < 512; ++t) tables_.level[t] = t < kLevelSums ? scan.level[t] : kPackedLevels - 1;
  std::fill(std::begin(tables_.first_place), std::end(tables_.first_place), 512);
  for (unsigned place = 0; place < 512; ++place) {
    const unsigned index = scan.index[place];
    // The first four are counted one by one: place 0 is not coded, the others look at each other.
    const bool first = place < 4;
    tables_.weight[index] = scan.weight[place];
    tables_.place[index] = first ? 512 : static_cast<std::int32_t>(place);
    tables_.context[index] = static_cast<std::int32_t>(scan.band[place] * kPackedLevels);
    std::int32_t& least = tables_.first_place[index / 8];
    least = std::min(least, tables_.place[index]);
  }
}

RowCosts::Sum RowCosts::of(const MagnitudeRows& magnitudes, unsigned end) const {
  const BlockScan& scan = kBlockScan;
  Sum sum;
  LaneSums sums;
  add_rows(tables_, magnitudes.padded, static_cast<std::int32_t>(kEndUnit * end), sums);
  for (int l = 0; l < 8; ++l) {
    sum.symbols += static_cast<std::uint32_t>(sums.symbols[l]);
    sum.raw += static_cast<std::uint32_t>(sums.raw[l]);
    sum.nonzero -= static_cast<std::uint32_t>(sums.zero[l]);
  }
  std::uint32_t before = 0;
  for (unsigned place = 1; place < 4; ++place) {
    const std::uint32_t m = magnitudes.at(scan.index[place]);
    sum.nonzero += m != 0 ? 1 : 0;
    const std::uint32_t t = scan.weight[place] * before;
    const unsigned level = t < kLevelSums ? scan.level[t] : kPackedLevels - 1;
    const unsigned extra = extra_bits(t);
    const std::uint32_t high = m >> extra;
    sum.symbols += static_cast<std::uint32_t>(
        tables_.cost[kPackedSymbols * (scan.band[place] * kPackedLevels + level) + std::min(high, kEscape)]);
    sum.raw += extra + (high >= kEscape ? escape_bits(high) : 0);
    before += m;
  }
  return sum;
}

}  // namespace weir
