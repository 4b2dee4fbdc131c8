#include "compressor/forecast/spread.h"

#include <gtest/gtest.h>

#include <array>

namespace weir::spread_test {
namespace {

TEST(Spread, IsStudentsIntervalOfTheParts) {
  const std::array<double, 4> parts{10, 12, 14, 16};  // standard deviation 2.58199
  const Expected all = spread_of(13.5, parts, 0);
  EXPECT_DOUBLE_EQ(all.value, 13.5);
  EXPECT_NEAR(all.low, 13.5 - 3.182 * 2.58199 / 2, 1e-4);
  EXPECT_NEAR(all.high, 13.5 + 3.182 * 2.58199 / 2, 1e-4);
}

TEST(Spread, OfMostOfTheVolume_IsNarrower) {
  const std::array<double, 4> parts{10, 12, 14, 16};
  EXPECT_NEAR(spread_of(13, parts, 0.75).high - 13, (spread_of(13, parts, 0).high - 13) / 2, 1e-12);
  EXPECT_EQ(spread_of(13, parts, 1).high, 13);
}

TEST(Spread, OfOnePart_IsNone) {
  const std::array<double, 1> parts{10};
  const Expected one = spread_of(11, parts, 0);
  EXPECT_EQ(one.low, 11);
  EXPECT_EQ(one.high, 11);
}

}  // namespace
}  // namespace weir::spread_test
