#include "format/packed/block_scan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <tuple>
#include <vector>

namespace weir::block_scan_test {
namespace {

struct Frequency {
  unsigned i, j, k;
};

Frequency frequency(unsigned index) { return {index / 64, index / 8 % 8, index % 8}; }
unsigned sum_of(unsigned index) {
  const auto [i, j, k] = frequency(index);
  return i + j + k;
}

TEST(BlockScan, OrderIsByShellThenSumThenIndex) {
  std::vector<unsigned> expected(512);
  std::iota(expected.begin(), expected.end(), 0U);
  const auto key = [](unsigned index) {
    const auto [i, j, k] = frequency(index);
    const unsigned most = std::max({i, j, k});
    return std::tuple{most < 2 ? 0 : most < 4 ? 1 : 2, i + j + k, index};
  };
  std::sort(expected.begin(), expected.end(), [&](unsigned a, unsigned b) { return key(a) < key(b); });
  for (unsigned place = 0; place < 512; ++place) {
    ASSERT_EQ(kBlockScan.index[place], expected[place]) << place;
    ASSERT_EQ(kBlockScan.place[expected[place]], place);
  }
  EXPECT_EQ(kBlockScan.index[0], 0);
  EXPECT_EQ(kBlockScan.index[7], 73);
  EXPECT_EQ(kBlockScan.index[511], 511);
}

TEST(BlockScan, BandsGrowWithTheSumOfFrequencies) {
  for (unsigned place = 0; place < 512; ++place) {
    const unsigned sum = sum_of(kBlockScan.index[place]);
    ASSERT_EQ(kBlockScan.band[place], sum < 2 ? 0 : sum < 6 ? 1 : sum < 10 ? 2 : 3) << place;
  }
}

TEST(BlockScan, NeighboursComeBeforeAndTheirWeightsMakeSixTimesTheMean) {
  for (unsigned place = 1; place < 512; ++place) {
    const unsigned index = kBlockScan.index[place];
    const auto [i, j, k] = frequency(index);
    std::vector<unsigned> expected;
    if (sum_of(index) == 1) {
      for (unsigned earlier = 1; earlier < place; ++earlier) expected.push_back(kBlockScan.index[earlier]);
    } else {
      if (i > 0) expected.push_back(index - 64);
      if (j > 0) expected.push_back(index - 8);
      if (k > 0) expected.push_back(index - 1);
    }
    std::vector<unsigned> found;
    for (const unsigned n : kBlockScan.neighbour[place]) {
      if (n == 512) continue;
      ASSERT_LT(kBlockScan.place[n], place);
      ASSERT_NE(n, 0U);
      found.push_back(n);
    }
    std::sort(found.begin(), found.end());
    std::sort(expected.begin(), expected.end());
    ASSERT_EQ(found, expected) << place;
    if (!found.empty()) {
      ASSERT_EQ(kBlockScan.weight[place] * found.size(), 6U);
    }
  }
}

TEST(BlockScan, LevelsAreThreeTimesTheLogarithmOfTheMeanRoundedDown) {
  ASSERT_EQ(kLevelSums, 321U);
  unsigned ties = 0;
  for (unsigned t = 0; t <= 320; ++t) {
    // Where 3 log2(1 + 2 t / 3) is whole, (3 + 2 t)^3 is 27 times a power of two, and so odd only where t is 0.
    const long double exact = 3 * std::log2(1 + 4 * static_cast<long double>(t) / 6);
    const long double nearest = std::nearbyint(exact);
    unsigned expected = static_cast<unsigned>(std::floor(exact));
    if (std::fabs(exact - nearest) < 1e-9L) {
      ++ties;
      const unsigned long long cube = 1ULL * (3 + 2 * t) * (3 + 2 * t) * (3 + 2 * t);
      const auto n = static_cast<unsigned>(nearest);
      expected = (27ULL << n) <= cube ? n : n - 1;
    }
    ASSERT_EQ(kBlockScan.level[t], std::min(23U, expected)) << t;
  }
  EXPECT_EQ(ties, 1U);
  EXPECT_EQ(kBlockScan.level[320], 23);
}

TEST(BlockScan, ExtraBitsAreTheLogarithmOfAThirdOfTheMeanUpToSixteen) {
  const auto expected = [](std::uint32_t t) {
    return t <= 36 ? 0U : std::min(16U, static_cast<unsigned>(std::bit_width(t / 18)) - 1);
  };
  for (std::uint32_t t = 0; t < 100000; ++t) ASSERT_EQ(extra_bits(t), expected(t)) << t;
  for (std::uint32_t t = 1; t <= 6U << 20U; t += 997) ASSERT_EQ(extra_bits(t), expected(t)) << t;
  EXPECT_EQ(extra_bits(71), 1U);
  EXPECT_EQ(extra_bits(72), 2U);
  EXPECT_EQ(extra_bits(6U << 20U), 16U);
}

}  // namespace
}  // namespace weir::block_scan_test
