#include "gpu/math/vector3.h"

#include <gtest/gtest.h>

#include <limits>

namespace weir::vector3_test {
namespace {

void expect_near(const Float3& a, const Float3& b) {
  EXPECT_NEAR(a.x, b.x, 1e-5);
  EXPECT_NEAR(a.y, b.y, 1e-5);
  EXPECT_NEAR(a.z, b.z, 1e-5);
}

TEST(Normalised, VectorsOfAnyLength_HaveLengthOne) {
  const Float3 fallback{0, 0, 1};
  for (const float length : {1e-40F, 1e-30F, 1e-24F, 1e-10F, 1.0F, 1e10F, 1e25F, 1e38F}) {
    expect_near(normalised({0.6F * length, -0.8F * length, 0}, fallback), {0.6F, -0.8F, 0});
  }
}

TEST(Normalised, VectorsWithoutADirection_AreTheFallback) {
  const Float3 fallback{0, 0, 1};
  const float infinity = std::numeric_limits<float>::infinity();
  EXPECT_EQ(normalised({0, 0, 0}, fallback), fallback);
  EXPECT_EQ(normalised({infinity, 0, 0}, fallback), fallback);
  EXPECT_EQ(normalised({1, std::numeric_limits<float>::quiet_NaN(), 0}, fallback), fallback);
}

}  // namespace
}  // namespace weir::vector3_test
