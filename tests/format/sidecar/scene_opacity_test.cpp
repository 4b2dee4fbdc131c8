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

}  // namespace
}  // namespace weir::scene_opacity_test
