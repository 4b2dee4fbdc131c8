#include "format/sidecar/scene_opacity.h"

#include <gtest/gtest.h>

namespace weir::scene_opacity_test {
namespace {

TEST(SceneOpacity, IsLinearBetweenPointsAndConstantBeyond) {
  // Position i / 1023.
  const std::vector<float> table = opacity_table({{341.0 / 1023, 0.25}, {682.0 / 1023, 0.75}});
  ASSERT_EQ(table.size(), 1024U);
  EXPECT_EQ(table[0], 0.25F);
  EXPECT_EQ(table[341], 0.25F);
  EXPECT_NEAR(table[511], 0.25F + 0.5F * 170 / 341, 1e-6F);
  EXPECT_EQ(table[682], 0.75F);
  EXPECT_EQ(table[1023], 0.75F);
}

TEST(SceneOpacity, TwoPointsAtOnePlaceAreAStep) {
  const std::vector<float> table = opacity_table({{0, 0}, {0.5, 0}, {0.5, 1}, {1, 1}});
  EXPECT_EQ(table[511], 0) << "0.4995";
  EXPECT_EQ(table[512], 1) << "0.5005";
}

TEST(SceneOpacity, BandBetweenTwoEntries_IsMissed) {
  // Entries 15 and 16 are at 0.014663 and 0.01564.
  const auto band = missed_band({{0, 0}, {0.0152, 0}, {0.0152, 1}, {0.0156, 0.5}, {0.0156, 0}, {1, 0}});
  ASSERT_TRUE(band);
  EXPECT_EQ(band->from, 0.0152);
  EXPECT_EQ(band->to, 0.0156);
  EXPECT_EQ(band->opacity, 1);
  EXPECT_EQ(band->shown, 0);
}

TEST(SceneOpacity, PeakBetweenTwoEntries_IsMissedWhereMoreThanATenthOfItIs) {
  const double middle = 511.5 / 1023;
  const auto peak_with_sides = [&](double entries) {
    return missed_band({{0, 0}, {middle - entries / 1023, 0}, {middle, 0.8}, {middle + entries / 1023, 0}, {1, 0}});
  };
  const auto missed = peak_with_sides(2);  // the entries beside it are at three quarters
  ASSERT_TRUE(missed);
  EXPECT_EQ(missed->from, middle);
  EXPECT_EQ(missed->to, middle);
  EXPECT_EQ(missed->opacity, 0.8);
  EXPECT_NEAR(missed->shown, 0.6, 1e-6);
  EXPECT_FALSE(peak_with_sides(6));
}

TEST(SceneOpacity, OfSeveralMissedBands_TheOneThatLosesMostIsTold) {
  const auto band = missed_band({{0, 0},
                                 {0.1001, 0},
                                 {0.1001, 0.3},
                                 {0.1001, 0},
                                 {0.5002, 0},
                                 {0.5002, 0.9},
                                 {0.5002, 0},
                                 {0.9003, 0},
                                 {0.9003, 0.9},
                                 {0.9003, 0},
                                 {1, 0}});
  ASSERT_TRUE(band);
  EXPECT_EQ(band->from, 0.5002) << "the first of the two";
  EXPECT_EQ(band->to, 0.5002);
  EXPECT_EQ(band->opacity, 0.9);
}

TEST(SceneOpacity, StepsAndBandsThatHoldAnEntry_AreNotMissed) {
  EXPECT_FALSE(missed_band({{0, 0}, {1, 1}}));
  EXPECT_FALSE(missed_band({{0, 1}, {0.5, 1}, {0.5, 0}, {1, 0}}));
  EXPECT_FALSE(missed_band({{0, 0}, {0.25, 0}, {0.25, 0.5}, {0.2504, 1}, {1, 1}}));
  EXPECT_FALSE(missed_band({{0, 0}, {0.9999, 0}, {1, 1}}));
  const double entry = 512.0 / 1023;  // as narrow as the others, and met
  EXPECT_FALSE(missed_band({{0, 0}, {entry - 1e-4, 0}, {entry, 1}, {entry + 1e-4, 0}, {1, 0}}));
  EXPECT_FALSE(missed_band({{0.3, 0}, {0.6, 0}}));
}

}  // namespace
}  // namespace weir::scene_opacity_test
