// A share of a block's error in two bytes is the nearest share that two bytes can hold.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "compressor/packed/packed_ladder.h"

namespace weir::error_share_test {
namespace {

// Returns the nearest share with eleven significant bits, as the type promises.
double nearest(double share) {
  int exponent = 0;
  const double mantissa = std::frexp(share, &exponent);
  return std::ldexp(std::nearbyint(std::ldexp(mantissa, 11)), exponent - 11);
}

TEST(ErrorShare, IsTheNearestOfElevenBits_OfTwoTheEvenOne) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> exponent(-61.9, 0);
  for (int i = 0; i < 100000; ++i) {
    const double share = std::exp2(exponent(random));
    ASSERT_EQ(ErrorShare(share).value(), nearest(share)) << share;
  }
  for (int m = 1024; m < 2048; ++m) {
    for (const double scale : {0x1p-11, 0x1p-40, 0x1p-72}) {
      const double half_way = (m + 0.5) * scale;
      ASSERT_EQ(ErrorShare(m * scale).value(), m * scale);
      ASSERT_EQ(ErrorShare(half_way).value(), nearest(half_way)) << half_way;
    }
  }
}

TEST(ErrorShare, EndsAtOne_AndIsNothingWhereTooSmall) {
  EXPECT_EQ(ErrorShare(1.0).value(), 1);
  EXPECT_EQ(ErrorShare(1.5).value(), 1);
  EXPECT_EQ(ErrorShare(std::nextafter(1.0, 0.0)).value(), 1);
  EXPECT_EQ(ErrorShare(0x1p-62).value(), 0x1p-62);
  EXPECT_EQ(ErrorShare(std::nextafter(0x1p-62, 0.0)).value(), 0x1p-62);
  EXPECT_EQ(ErrorShare(0x1.8p-63).value(), 0);
  EXPECT_EQ(ErrorShare(std::numeric_limits<double>::denorm_min()).value(), 0);
  EXPECT_EQ(ErrorShare(0.0).value(), 0);
  EXPECT_EQ(ErrorShare(std::numeric_limits<double>::quiet_NaN()).value(), 0);
}

}  // namespace
}  // namespace weir::error_share_test
