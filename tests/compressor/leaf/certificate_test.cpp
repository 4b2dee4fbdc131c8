#include "compressor/leaf/certificate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace weir::certificate_test {
namespace {

TEST(Certificate, FollowsItsFormulas) {
  const Certificate c = make_certificate(50, 3, false, 200, -2, 8);
  EXPECT_EQ(c.mse, 0.25);
  EXPECT_EQ(c.rmse, 0.5);
  EXPECT_DOUBLE_EQ(c.nmse, 0.25 / 100);
  ASSERT_TRUE(c.psnr_db);
  EXPECT_DOUBLE_EQ(*c.psnr_db, 10 * std::log10(100 / 0.25));
  EXPECT_EQ(c.max_abs, 3);
  EXPECT_FALSE(c.lossless);
}

TEST(Certificate, ZeroErrorHasNoPsnr) {
  const Certificate c = make_certificate(0, 0, true, 200, 0, 1);
  EXPECT_FALSE(c.psnr_db);
  EXPECT_EQ(c.mse, 0);
  EXPECT_EQ(c.nmse, 0);
  EXPECT_TRUE(c.lossless);
}

TEST(Certificate, RangesBeyondFloatAndBelowNormalStayFinite) {
  const Certificate huge = make_certificate(9e76 * 10, 6e38, false, 10, -3e38F, 3e38F);
  const double range = 2 * static_cast<double>(3e38F);
  EXPECT_NEAR(huge.nmse, 9e76 / (range * range), 1e-15);
  const Certificate tiny = make_certificate(1e-90 * 4, 1e-45, false, 4, 0, 0x1p-149F);
  EXPECT_NEAR(tiny.nmse, 1e-90 / std::ldexp(1.0, -298), 1e-12);
  EXPECT_TRUE(tiny.psnr_db);
}

TEST(Certificate, ErrorInAConstantVolume_HasInfiniteNmse) {
  const Certificate c = make_certificate(25 * 8, 5, false, 8, 5, 5);
  EXPECT_EQ(c.mse, 25);
  EXPECT_EQ(c.nmse, std::numeric_limits<double>::infinity());
  EXPECT_FALSE(c.psnr_db);
  EXPECT_EQ(make_certificate(0, 0, true, 8, 5, 5).nmse, 0);
}

TEST(Certificate, NoFiniteValues_GiveZeroError) {
  const Certificate c = make_certificate(0, 0, true, 0, 0, 0);
  EXPECT_EQ(c.mse, 0);
  EXPECT_EQ(c.rmse, 0);
  EXPECT_FALSE(c.psnr_db);
}

TEST(CompensatedSum, KeepsSmallTermsBesideLargeOnes) {
  CompensatedSum sum;
  sum.add(1e16);
  for (int i = 0; i < 1000; ++i) sum.add(1);
  sum.add(-1e16);
  EXPECT_EQ(sum.value(), 1000);
  CompensatedSum tenth;
  for (int i = 0; i < 10'000'000; ++i) tenth.add(0.1);
  EXPECT_NEAR(tenth.value(), 1e6, 1e-9);
}

}  // namespace
}  // namespace weir::certificate_test
