#include "compressor/survey/survey_tally.h"

#include <gtest/gtest.h>

#include <bit>

namespace weir::survey_tally_test {
namespace {

SurveyTally tally(float low, float high, std::int64_t bad) {
  SurveyTally t;
  t.min = low;
  t.max = high;
  t.finite = 10;
  t.missing = 2;
  t.non_finite = 1;
  t.first_non_finite = bad;
  t.first_non_finite_value = static_cast<float>(bad);
  t.histogram.add(low, 9);
  t.histogram.add(high, 1);
  t.value_counts = {1, 0, 5};
  t.loss = {3, 4, static_cast<double>(bad)};
  return t;
}

TEST(SurveyTally, MergesInAnyOrder) {
  const SurveyTally a = tally(-0.0F, 5, 70);
  const SurveyTally b = tally(0.0F, 900, 7);
  for (const bool swapped : {false, true}) {
    SurveyTally sum;
    sum.merge(swapped ? b : a);
    sum.merge(swapped ? a : b);
    EXPECT_EQ(std::bit_cast<std::uint32_t>(sum.min), 0U) << "never -0.0";
    EXPECT_EQ(sum.max, 900);
    EXPECT_EQ(sum.finite, 20U);
    EXPECT_EQ(sum.missing, 4U);
    EXPECT_EQ(sum.non_finite, 2U);
    EXPECT_EQ(sum.first_non_finite, 7);
    EXPECT_EQ(sum.first_non_finite_value, 7);
    EXPECT_EQ(sum.value_counts, (std::vector<std::uint64_t>{2, 0, 10}));
    EXPECT_EQ(sum.loss.inexact, 6U);
    EXPECT_EQ(sum.loss.overflow, 8U);
    EXPECT_EQ(sum.loss.max_abs_error, 70);
    EXPECT_EQ(sum.histogram.counts().size(), 901U);
    EXPECT_EQ(sum.histogram.counts().front(), 18U);
  }
}

TEST(SurveyTally, MergingAnEmptyTallyChangesNothing) {
  SurveyTally sum = tally(1, 2, 3);
  sum.merge({});
  EXPECT_EQ(sum.min, 1);
  EXPECT_EQ(sum.max, 2);
  EXPECT_EQ(sum.first_non_finite, 3);
  EXPECT_EQ(sum.value_counts.size(), 3U);
}

}  // namespace
}  // namespace weir::survey_tally_test
