#include "compressor/select/key_sums.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

namespace weir::key_sums_test {
namespace {

TEST(KeySums, WholePartsAreThoseOfTheCompilersConversion) {
  for (const double value :
       {0.0, -0.0, std::numeric_limits<double>::denorm_min(), 0.5, std::nextafter(1.0, 0.0), 1.0, 1.5, 0x1p52,
        0x1p52 + 1, 0x1p53 - 1, 0x1p53, 0x1.fffffffffffffp53, 0x1p64, 0x1.8p100, 0x1.fffffffffffffp127}) {
    EXPECT_EQ(whole_part(value) == static_cast<PurchaseSum::Weight>(value), true) << value;
  }
  std::mt19937_64 random(7);
  for (int i = 0; i < 100000; ++i) {
    const double value = std::ldexp(static_cast<double>(random() >> 11U), static_cast<int>(random() % 180) - 105);
    ASSERT_EQ(whole_part(value) == static_cast<PurchaseSum::Weight>(value), true) << value;
  }
}

TEST(KeySums, GainsAreCountedInWholeUnits) {
  EXPECT_EQ(static_cast<std::uint64_t>(gain_weight(10.0, 4.0)), 2U);
  EXPECT_EQ(static_cast<std::uint64_t>(gain_weight(-1.0, 4.0)), 0U);
  EXPECT_EQ(static_cast<std::uint64_t>(gain_weight(12.0, 0.5)), 24U);
}

}  // namespace
}  // namespace weir::key_sums_test
