#include "gpu/math/random.h"

#include <gtest/gtest.h>

#include <set>

namespace weir::random_test {
namespace {

TEST(Random, SameSeedSameStream) {
  Random a(1, 2, 3);
  Random b(1, 2, 3);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(a.bits(), b.bits());
}

// A seed promises a picture: these values may change only with a note to users.
TEST(Random, GoldenValues) {
  Random random(1, 2, 3);
  EXPECT_EQ(random.bits(), 2610585923U);
  EXPECT_EQ(random.bits(), 89403283U);
}

TEST(Random, SeedPixelAndSampleAllMatter) {
  std::set<std::uint32_t> first;
  for (std::uint64_t k = 0; k < 64; ++k) {
    first.insert(Random(k, 0, 0).bits());
    first.insert(Random(0, k + 1, 0).bits());
    first.insert(Random(0, 0, k + 1).bits());
  }
  EXPECT_EQ(first.size(), 192U);
}

TEST(Random, UniformStaysBelowOne) {
  double sum = 0;
  for (std::uint64_t k = 0; k < 100000; ++k) {
    Random random(5, k, 0);
    const float u = random.uniform();
    ASSERT_GE(u, 0.0F);
    ASSERT_LT(u, 1.0F);
    sum += static_cast<double>(u);
  }
  EXPECT_NEAR(sum / 100000, 0.5, 5 * 0.2887 / std::sqrt(100000.0));
}

TEST(FreeDepth, EndsOfTheUnitInterval) {
  EXPECT_EQ(free_depth(0.0F), 0.0F);
  EXPECT_NEAR(free_depth(1.0F - 0x1p-24F), 16.6355F, 1e-3F);
}

}  // namespace
}  // namespace weir::random_test
