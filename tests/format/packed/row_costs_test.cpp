#include "format/packed/row_costs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>

#include "format/packed/block_encode.h"
#include "tests/format/packed/block_samples.h"

namespace weir::row_costs_test {
namespace {

using packed_test::Numbers;

// As the format has it, one coefficient after the other.
RowCosts::Sum count_plainly(const SymbolCosts& costs, const std::array<std::uint32_t, 512>& by_index, unsigned end) {
  RowCosts::Sum sum;
  for (unsigned place = 1; place < 16 * end; ++place) {
    const unsigned index = kBlockScan.index[place];
    const unsigned i = index / 64;
    const unsigned j = index / 8 % 8;
    const unsigned k = index % 8;
    std::uint64_t near = 0;
    unsigned count = 0;
    const auto add = [&](unsigned neighbour) {
      near += std::min(by_index[neighbour], 1U << 20U);
      ++count;
    };
    if (i + j + k == 1) {
      for (unsigned earlier = 1; earlier < place; ++earlier) add(kBlockScan.index[earlier]);
    } else {
      if (i > 0) add(index - 64);
      if (j > 0) add(index - 8);
      if (k > 0) add(index - 1);
    }
    const std::uint64_t t = count == 0 ? 0 : near * 6 / count;
    const unsigned level = t <= 320 ? kBlockScan.level[t] : 23;
    const unsigned band = i + j + k < 2 ? 0 : i + j + k < 6 ? 1 : i + j + k < 10 ? 2 : 3;
    const unsigned extra = t <= 36 ? 0 : std::min(16U, static_cast<unsigned>(std::bit_width(t / 18)) - 1);
    const std::uint32_t high = by_index[index] >> extra;
    sum.symbols += costs[band * 24 + level][std::min(high, 15U)];
    sum.raw += extra;
    if (high >= 15) sum.raw += 5 + static_cast<unsigned>(std::bit_width(high - 14)) - 1;
    if (by_index[index] != 0) ++sum.nonzero;
  }
  return sum;
}

TEST(RowCosts, OfEqualsTheCountOneByOne) {
  const SymbolCosts costs = symbol_costs(built_in_tables());
  const RowCosts rows(costs);
  Numbers numbers(7);
  for (int trial = 0; trial < 3000; ++trial) {
    const std::uint32_t largest_bits = numbers.below(24);
    const std::uint32_t share = 1 + numbers.below(16);
    MagnitudeRows magnitudes;
    if (trial % 2 != 0) magnitudes.live = 0;
    std::array<std::uint32_t, 512> by_index{};
    for (unsigned index = 1; index < 512; ++index) {
      if (numbers.below(trial % 3 == 0 ? 256 : 16) >= share) continue;
      magnitudes.live |= std::uint64_t{1} << (index / 8);
      by_index[index] = numbers.bits() & ((1U << numbers.below(largest_bits + 1)) - 1U);
      magnitudes.row(index / 8)[index % 8] = static_cast<std::int32_t>(by_index[index]);
    }
    const unsigned end = 1 + (trial < 32 ? static_cast<unsigned>(trial) : numbers.below(32));
    const RowCosts::Sum expected = count_plainly(costs, by_index, end);
    const RowCosts::Sum found = rows.of(magnitudes, end);
    ASSERT_EQ(found.symbols, expected.symbols) << trial;
    ASSERT_EQ(found.raw, expected.raw) << trial;
    ASSERT_EQ(found.nonzero, expected.nonzero) << trial;
  }
}

TEST(RowCosts, LargestMagnitudesAreCounted) {
  const SymbolCosts costs = symbol_costs(built_in_tables());
  const RowCosts rows(costs);
  MagnitudeRows magnitudes;
  std::array<std::uint32_t, 512> by_index{};
  for (unsigned index = 1; index < 512; ++index) {
    by_index[index] = RowCosts::kMostMagnitude - 1;
    magnitudes.row(index / 8)[index % 8] = RowCosts::kMostMagnitude - 1;
  }
  const RowCosts::Sum expected = count_plainly(costs, by_index, 32);
  const RowCosts::Sum found = rows.of(magnitudes, 32);
  EXPECT_EQ(found.symbols, expected.symbols);
  EXPECT_EQ(found.raw, expected.raw);
  EXPECT_EQ(found.nonzero, 511U);
}

}  // namespace
}  // namespace weir::row_costs_test
