#include "gpu/image/flip_color.h"

#include <gtest/gtest.h>

#include <cmath>

namespace weir::flip_color_test {
namespace {

void expect_near(const Float3& found, const Float3& expected, float tolerance) {
  EXPECT_NEAR(found.x, expected.x, tolerance);
  EXPECT_NEAR(found.y, expected.y, tolerance);
  EXPECT_NEAR(found.z, expected.z, tolerance);
}

TEST(FlipColor, BlackAndWhiteHaveNoColor) {
  expect_near(opponent_from_linear({0, 0, 0}), {-16, 0, 0}, 0);
  expect_near(opponent_from_linear({1, 1, 1}), {100, 0, 0}, 1e-4F);
  expect_near(hunt_lab({0, 0, 0}), {0, 0, 0}, 1e-5F);
  expect_near(hunt_lab({1, 1, 1}), {100, 0, 0}, 1e-4F);
}

TEST(FlipColor, OpponentSpaceRoundTrips) {
  for (const Float3& rgb : {Float3{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.2F, 0.01F, 0.7F}, {1.5F, -0.5F, 3}}) {
    expect_near(linear_from_opponent(opponent_from_linear(rgb)), rgb, 2e-6F);
  }
}

// CIELAB of the primaries of sRGB under D65, from tables of colorimetry; a and b are multiplied by L / 100.
TEST(FlipColor, HuntLabOfPrimaries) {
  expect_near(hunt_lab({1, 0, 0}), {53.24F, 80.09F * 0.5324F, 67.20F * 0.5324F}, 0.02F);
  expect_near(hunt_lab({0, 1, 0}), {87.73F, -86.18F * 0.8773F, 83.18F * 0.8773F}, 0.02F);
  expect_near(hunt_lab({0, 0, 1}), {32.30F, 79.19F * 0.3230F, -107.86F * 0.3230F}, 0.02F);
  expect_near(hunt_lab({0.001F, 0.001F, 0.001F}), {0.9033F, 0, 0}, 1e-3F);  // on the line near black
}

TEST(FlipColor, Hyab) {
  EXPECT_FLOAT_EQ(hyab_difference({10, 0, 0}, {7, 3, -4}), std::pow(8.0F, 0.7F));
  EXPECT_EQ(hyab_difference({10, 2, 3}, {10, 2, 3}), 0);
}

TEST(FlipColor, RedistributedBendsAtFourTenths) {
  const float largest = hyab_difference(hunt_lab({0, 1, 0}), hunt_lab({0, 0, 1}));
  EXPECT_EQ(redistributed(0), 0);
  EXPECT_NEAR(redistributed(0.2F * largest), 0.475F, 1e-6F);
  EXPECT_NEAR(redistributed(0.4F * largest), 0.95F, 1e-6F);
  EXPECT_NEAR(redistributed(0.7F * largest), 0.975F, 1e-6F);
  EXPECT_FLOAT_EQ(redistributed(largest), 1);
}

TEST(FlipColor, NoTwoColorsDifferMoreThanGreenAndBlue) {
  const auto color = [](int i) {
    return Float3{static_cast<float>(i % 5) / 4, static_cast<float>(i / 5 % 5) / 4, static_cast<float>(i / 25) / 4};
  };
  for (int i = 0; i < 125; ++i) {
    for (int j = 0; j < i; ++j) {
      EXPECT_LE(redistributed(hyab_difference(hunt_lab(color(i)), hunt_lab(color(j)))), 1.0F) << i << ' ' << j;
    }
  }
}

}  // namespace
}  // namespace weir::flip_color_test
