#include "gpu/trace/ray_march.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/gpu/support/test_medium.h"

namespace weir::ray_march_test {
namespace {

using test::TestMedium;

Lighting dark() {
  Lighting lighting;
  lighting.sky_behind = false;
  return lighting;
}

// L = c (1 - exp(-sigma d)) + exp(-sigma d) behind.
TEST(March, HomogeneousSlab) {
  Lighting lighting = dark();
  lighting.background = {0.25F, 0.25F, 0.25F};
  for (const float density : {0.0F, 0.01F, 0.05F}) {
    TestMedium medium({64, 16, 16}, 16, density, 1.0F, [](const Float3&) { return 0.5F; });
    Random random(1, 2, 3);
    const double through = std::exp(-0.5 * static_cast<double>(density) * 64);
    EXPECT_NEAR(static_cast<double>(march(*medium, lighting, {-9, 8, 8}, {1, 0, 0}, 0.5F, 0, random).x),
                1 - through + 0.25 * through, 1e-4 + 0.03 * static_cast<double>(density));
  }
}

TEST(March, SlabThinnerThanAStep) {
  TestMedium medium({64, 16, 16}, 16, 4, 1.0F, [](const Float3&) { return 0.5F; });
  medium->shown = {{8, 0, 0}, {8.25F, 16, 16}};
  for (std::uint32_t i = 0; i < 20; ++i) {
    Random random(1, i, 0);
    EXPECT_NEAR(march(*medium, dark(), {-9, 8, 8}, {1, 0, 0}, 0.5F, 0, random).x, 1 - std::exp(-0.5F * 4 * 0.25F),
                1e-5F);
  }
}

TEST(March, EmptyCellsChangeNothing) {
  const auto f = [](const Float3& p) { return p.x >= 20 && p.x < 40 ? 0.3F : 0.0F; };
  TestMedium loose({64, 16, 16}, 16, 0.1F, 0.3F, f);
  TestMedium tight({64, 16, 16}, 16, 0.1F, 0.3F, f);
  tight.opacity()[0] = tight.opacity()[3] = 0;
  const Lighting lighting = dark();
  for (std::uint32_t i = 0; i < 50; ++i) {
    Random a(1, i, 0);
    Random b(1, i, 0);
    const Float3 direction = normalised(Float3{1, 0.05F, 0.02F}, {});
    EXPECT_EQ(march(*loose, lighting, {-5, 7, 7}, direction, 0.5F, 0, a),
              march(*tight, lighting, {-5, 7, 7}, direction, 0.5F, 0, b));
  }
}

TEST(March, HugeExtinctionIsTheFirstColour) {
  TestMedium medium({64, 16, 16}, 16, 3e38F, 1.0F, [](const Float3&) { return 1.0F; });
  Random random(1, 2, 3);
  EXPECT_EQ(march(*medium, dark(), {-9, 8, 8}, {1, 0, 0}, 0.5F, 0, random), (Float3{1, 1, 1}));
}

TEST(March, MissesSeeTheBackground) {
  Lighting lighting = dark();
  lighting.background = {0.1F, 0.2F, 0.3F};
  TestMedium medium({64, 16, 16}, 16, 1, 1.0F, [](const Float3&) { return 1.0F; });
  Random random(1, 2, 3);
  EXPECT_EQ(march(*medium, lighting, {-9, 8, 8}, {-1, 0, 0}, 0.5F, 0.5F, random), lighting.background);
  EXPECT_EQ(march(*medium, lighting, {64, 8, 8}, {1, 0, 0}, 0.5F, 0.5F, random), lighting.background);
}

// A wall at x = 32 whose normal faces the camera reflects what on_surface says.
TEST(March, SurfaceFacingTheCameraReflectsTheAmbientLight) {
  Lighting lighting = dark();
  lighting.zenith = lighting.horizon = lighting.ground = {0.5F, 0.5F, 0.5F};
  TestMedium medium({64, 16, 16}, 16, 1e6F, 1.0F, [](const Float3& p) { return p.x >= 32 ? 1.0F : 0.0F; });
  Random random(1, 2, 3);
  EXPECT_NEAR(march(*medium, lighting, {0, 8, 8}, {1, 0, 0}, 0.5F, 1, random).x, 0.5F, 1e-6F);
  EXPECT_NEAR(march(*medium, lighting, {0, 8, 8}, {1, 0, 0}, 0.5F, 0.5F, random).x, 0.75F, 1e-6F);
}

// kUnshaded bounds the unlit opacity of the whole ray: without light, a thin fog is as black as a dense one.
TEST(March, FogWithoutLight_IsBlackHoweverThinItIs) {
  Lighting lighting = dark();
  lighting.zenith = lighting.horizon = lighting.ground = {0, 0, 0};
  lighting.lights[0] = {{0, 0, 1}, {0, 0, 0}};
  lighting.light_count = 1;
  for (const float opacity : {2e-5F, 2e-4F, 2e-3F, 2e-2F}) {
    TestMedium medium({1024, 16, 16}, 16, 200.0F / 1024, opacity, [=](const Float3&) { return opacity; });
    for (std::uint32_t i = 0; i < 20; ++i) {
      Random random(1, i, 0);
      const float lit = march(*medium, lighting, {-9, 8, 8}, {1, 0, 0}, 0.5F, 1, random).x;
      EXPECT_GE(lit, 0.0F) << opacity;
      EXPECT_LE(lit, kUnshaded + 1e-6F) << opacity;
    }
  }
}

// All of a constant fog reflects half of the surroundings' light. The colour is off by kUnshaded at most.
TEST(March, ThinFogReflectsTheAmbientLight) {
  Lighting lighting = dark();
  lighting.zenith = lighting.horizon = lighting.ground = {0.5F, 0.5F, 0.5F};
  TestMedium medium({1024, 16, 16}, 16, 200.0F / 1024, 0.002F, [](const Float3&) { return 0.002F; });
  Random random(1, 2, 3);
  EXPECT_NEAR(march(*medium, lighting, {-9, 8, 8}, {1, 0, 0}, 0.5F, 1, random).x, 0.5F * (1 - std::exp(-0.4F)),
              kUnshaded + 1e-4F);
}

// A white medium of radiance 1 before a background of 1000: T = exp(-7.7) of the background is visible, although the
// ray ends there.
TEST(March, RayThatEndsEarly_StillSeesTheBackground) {
  Lighting lighting = dark();
  lighting.background = {1000, 1000, 1000};
  for (const float depth : {7.4F, 7.6F, 7.62F, 7.63F, 7.7F}) {
    TestMedium medium({32, 32, 32}, 16, depth / 32, 1.0F, [](const Float3&) { return 1.0F; });
    for (std::uint32_t i = 0; i < 20; ++i) {
      Random random(1, i, 0);
      const float seen = march(*medium, lighting, {-9, 16, 16}, {1, 0, 0}, 0.5F, 0, random).x;
      EXPECT_NEAR(seen, 1 + 999 * std::exp(-depth), 1e-3F) << depth;
    }
  }
}

// Behind a medium of any depth, at most the share kOpaque of the background is counted too much.
TEST(March, BackgroundBehindAWall_IsLeftOutButForAShare) {
  Lighting lighting = dark();
  lighting.background = {1000, 1000, 1000};
  for (const float depth : {8.0F, 20.0F, 200.0F, 1e6F}) {
    TestMedium medium({32, 32, 32}, 16, depth / 32, 1.0F, [](const Float3&) { return 1.0F; });
    Random random(1, 2, 3);
    const float seen = march(*medium, lighting, {-9, 16, 16}, {1, 0, 0}, 0.5F, 0, random).x;
    EXPECT_GE(seen, 1 - kOpaque) << depth;
    EXPECT_LE(seen, 1 + 1000 * kOpaque) << depth;
  }
}

}  // namespace
}  // namespace weir::ray_march_test
