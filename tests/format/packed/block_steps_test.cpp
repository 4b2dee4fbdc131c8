#include "format/packed/block_steps.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "format/packed/block_encode.h"

namespace weir::block_steps_test {
namespace {

TEST(BlockSteps, EvenStepsArePowersOfTwoAndOddOnesRoundedOnce) {
  for (std::int32_t step = kLeastStep; step <= kMostStep; ++step) {
    const int half = step % 2 == 0 ? step / 2 : (step - 1) / 2;
    ASSERT_EQ(step_size(step), std::ldexp(step % 2 == 0 ? 1.0F : 0.70710678F, -half)) << step;
    if (step > kLeastStep) {
      ASSERT_LT(step_size(step), step_size(step - 1));
    }
  }
  EXPECT_EQ(step_size(0), 1.0F);
  EXPECT_EQ(step_size(1), 0.70710678F);
  EXPECT_EQ(step_size(-1), 1.41421356F);
  EXPECT_EQ(step_size(-250), 0x1p125F);
  EXPECT_EQ(step_size(250), 0x1p-125F);
}

TEST(BlockSteps, MeansLieAStepByTheRootOf512Apart) {
  for (std::int32_t step = kLeastStep; step <= kMostStep; ++step) {
    const float product = step_size(step) * 0.044194173F;
    ASSERT_EQ(mean_quantum(step), product);
    ASSERT_GT(mean_quantum(step), 0.0F);  // denormal at the finest
  }
}

// Bits as the format defines them, by whole numbers.
unsigned expected_bits(const MeanRange& range, std::int32_t step) {
  const float width = range.high - range.low;
  const float codes = width / mean_quantum(step);
  const double last = std::floor(static_cast<double>(codes)) + 1;
  if (!(last < 16777216)) return kNoMeanBits;
  unsigned bits = 0;
  for (auto rest = static_cast<std::uint32_t>(last); rest != 0; rest /= 2) ++bits;
  return bits;
}

TEST(BlockSteps, MeanBitsHoldTheLastCode) {
  const float quantum = mean_quantum(0);
  for (const float width : {0.0F, 1e-30F, 0.5F * quantum, quantum, 2 * quantum, 3 * quantum, 63 * quantum,
                            1000 * quantum, 8388607 * quantum, 16777000 * quantum}) {
    const MeanRange range{0, width};
    ASSERT_EQ(mean_bits(range, 0), expected_bits(range, 0)) << width;
  }
  EXPECT_EQ(mean_bits({5, 5}, 0), 1U);
  EXPECT_EQ(mean_bits({0, quantum}, 0), 2U);
  EXPECT_EQ(mean_bits({0, 3 * quantum}, 0), 3U);
  EXPECT_EQ(mean_bits({0, 16777212 * quantum}, 0), 24U);
}

TEST(BlockSteps, RangesTooWideForTheStepHaveNoMeanBits) {
  constexpr float kMax = std::numeric_limits<float>::max();
  EXPECT_EQ(mean_bits({0, 16777216 * mean_quantum(0)}, 0), kNoMeanBits);
  EXPECT_EQ(mean_bits({-kMax, kMax}, kLeastStep), kNoMeanBits);  // the width is infinite
  EXPECT_EQ(mean_bits({0, 1}, kMostStep), kNoMeanBits);
  EXPECT_NE(mean_bits({0, kMax}, kLeastStep), kNoMeanBits);
  EXPECT_EQ(mean_bits({0, std::numeric_limits<float>::denorm_min()}, kLeastStep), 1U);
}

TEST(BlockTables, CumulativeFrequenciesRiseStrictlyFromZeroToBelow4096) {
  const std::uint16_t* tables = built_in_tables();
  for (unsigned table = 0; table < kPackedTables; ++table, tables += kPackedSymbols) {
    ASSERT_EQ(tables[0], 0) << table;
    for (unsigned j = 1; j < kPackedSymbols; ++j) ASSERT_GT(tables[j], tables[j - 1]) << table << ' ' << j;
    ASSERT_LT(tables[kPackedSymbols - 1], 4096) << table;
  }
}

}  // namespace
}  // namespace weir::block_steps_test
