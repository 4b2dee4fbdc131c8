#include "gpu/trace/max_projection.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/gpu/support/test_medium.h"

namespace weir::max_projection_test {
namespace {

using test::TestMedium;

TEST(MaxAlong, PeakOnTheRay) {
  TestMedium medium({64, 16, 16}, 16, 1, 1.0F, [](const Float3& p) { return 1 - std::abs(p.x - 40) / 64; });
  const Ray ray = medium->ray({0, 8, 8}, {1, 0, 0});
  EXPECT_EQ(max_along(*medium, ray, 64, 0.5F, 0), 1.0F);
  EXPECT_NEAR(max_along(*medium, ray, 64, 0.5F, 0.5F), 1.0F, 0.25F / 64 + 1e-6F);
  EXPECT_EQ(max_along(*medium, ray, 10, 0.5F, 0), 1 - 30.5F / 64) << "the end of the ray is outside";
}

TEST(MaxAlong, RayShorterThanAStep_HasASample) {
  TestMedium medium({1, 1, 1}, 16, 1, 1.0F, [](const Float3&) { return 0.25F; });
  const Ray ray = medium->ray({0, 0, 0.5F}, {0.6F, 0.8F, 0});
  for (const float jitter : {0.0F, 0.5F, 0.99F}) {
    EXPECT_EQ(max_along(*medium, ray, 0.1F, 0.5F, jitter), 0.25F);
    EXPECT_EQ(max_along(*medium, ray, 1, 1000.0F, jitter), 0.25F) << "where voxels are far from cubes";
  }
}

TEST(MaxAlong, SkipsCellsThatCannotRaiseIt) {
  int lookups = 0;
  TestMedium medium({64, 16, 16}, 16, 1, 1.0F, [&](const Float3& p) {
    ++lookups;
    return p.x < 16 ? 1.0F : 0.5F;
  });
  EXPECT_EQ(max_along(*medium, medium->ray({0, 8, 8}, {1, 0, 0}), 64, 0.5F, 0), 1.0F);
  EXPECT_EQ(lookups, 32);
}

TEST(MaxAlong, NotANumberDoesNotCount) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  TestMedium medium({64, 16, 16}, 16, 1, 1.0F,
                    [nan](const Float3& p) { return p.x < 16 ? nan : (p.x < 32 ? kInfinity : 0.25F); });
  EXPECT_EQ(max_along(*medium, medium->ray({0, 8, 8}, {1, 0, 0}), 64, 0.5F, 0), 0.25F);
  TestMedium none({64, 16, 16}, 16, 1, 1.0F, [nan](const Float3&) { return nan; });
  EXPECT_EQ(max_along(*none, none->ray({0, 8, 8}, {1, 0, 0}), 64, 0.5F, 0), -kInfinity);
}

TEST(ProjectMax, IsBlendedOverTheBackground) {
  Lighting lighting;
  lighting.sky_behind = false;
  lighting.background = {0.5F, 0.5F, 0.5F};
  TestMedium medium({64, 16, 16}, 16, 1, 1.0F, [](const Float3&) { return 0.25F; });
  Random random(1, 2, 3);
  EXPECT_NEAR(project_max(*medium, lighting, {-1, 8, 8}, {1, 0, 0}, 0.5F, random).x, 0.625F, 1e-6F);
  EXPECT_EQ(project_max(*medium, lighting, {-1, 8, 8}, {-1, 0, 0}, 0.5F, random).x, 0.5F);
}

}  // namespace
}  // namespace weir::max_projection_test
