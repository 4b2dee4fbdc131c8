#include "gpu/trace/iso_surface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "gpu/math/random.h"
#include "tests/gpu/support/test_medium.h"

namespace weir::iso_surface_test {
namespace {

using test::TestMedium;

// Returns the distance from the centre of a 64^3 volume, so that the surface of value r is a sphere.
const auto kDistance = [](const Float3& p) { return length(p - Float3{32, 32, 32}) / 64; };

TEST(FindIso, SphereOnRandomRays) {
  TestMedium medium({64, 64, 64}, 16, 1, 1.0F, kDistance);
  int hits = 0;
  for (std::uint64_t k = 0; k < 3000; ++k) {
    Random random(5, k, 0);
    const auto component = [&] { return 2 * random.uniform() - 1; };
    const Float3 direction = normalised(Float3{component(), component(), component()}, {1, 0, 0});
    const Float3 offset{component() * 25, component() * 25, component() * 25};
    Ray ray = medium->ray(Float3{32, 32, 32} + offset - direction * 200, direction);
    const float distance = enter(ray, medium->shown);
    if (distance == 0) continue;
    const float t = find_iso(*medium, ray, distance, 20.0F / 64, 0.5F);
    const Float3 to_centre = Float3{32, 32, 32} - ray.origin;
    const float along = dot(to_centre, direction);
    const float closest = std::sqrt(greater(0.0F, dot(to_centre, to_centre) - along * along));
    if (closest > 20.01F) {
      EXPECT_EQ(t, -1.0F);
    } else if (closest < 19.5F) {
      EXPECT_NEAR(t, along - std::sqrt(400 - closest * closest), 1e-3F);
    }
    hits += t >= 0 ? 1 : 0;
  }
  EXPECT_GT(hits, 500);
}

TEST(FindIso, FromInside) {
  TestMedium medium({64, 64, 64}, 16, 1, 1.0F, kDistance);
  EXPECT_NEAR(find_iso(*medium, medium->ray({32, 32, 32}, {0, 0, -1}), 32, 20.0F / 64, 0.5F), 20.0F, 1e-3F);
}

TEST(FindIso, NoSurfaceIsFoundAcrossNaN) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  TestMedium medium({64, 16, 16}, 16, 1, 1.0F,
                    [nan](const Float3& p) { return p.x < 30 ? 0.0F : (p.x < 34 ? nan : 1.0F); });
  EXPECT_EQ(find_iso(*medium, medium->ray({0, 8, 8}, {1, 0, 0}), 64, 0.5F, 0.5F), -1.0F);
}

// A surface is where values below iso meet iso or more, so a plateau of exactly iso lies above it.
TEST(FindIso, OfAPlateausValue_TheSurfaceIsThePlateausLowerSide) {
  const auto steps = [](const Float3& p) { return p.x < 20 ? 0.0F : p.x < 40 ? 0.5F : 1.0F; };
  TestMedium medium({64, 16, 16}, 16, 1, 1.0F, steps);
  const auto crossing = [&](float iso) { return find_iso(*medium, medium->ray({0, 8, 8}, {1, 0, 0}), 64, iso, 0.5F); };
  EXPECT_NEAR(crossing(0.5F), 20, 1e-3F);
  EXPECT_NEAR(crossing(1.0F), 40, 1e-3F);
  EXPECT_EQ(crossing(0.0F), -1.0F);
}

// Rounds as blends of eight equal voxels do.
TEST(FindIso, RoundingInAPlateauOfIsosValue_IsNoSurface) {
  const auto rounded = [](const Float3& p) {
    if (p.x < 20) return 0.3F;
    return p.x - std::floor(p.x) < 0.4F ? std::nextafter(0.7F, 0.0F) : 0.7F;
  };
  TestMedium medium({64, 16, 16}, 16, 1, 1.0F, rounded);
  const auto crossing = [&](float x) {
    return find_iso(*medium, medium->ray({x, 8, 8}, {1, 0, 0}), 64 - x, 0.7F, 0.3F);
  };
  EXPECT_EQ(crossing(25), -1.0F);
  EXPECT_NEAR(crossing(0), 20, 1e-3F);
}

TEST(FindIso, StepBelowFloatPrecisionTerminates) {
  TestMedium medium({64, 16, 16}, 16, 1, 1.0F, [](const Float3&) { return 0.0F; });
  EXPECT_EQ(find_iso(*medium, medium->ray({0, 8, 8}, {1, 0, 0}), 64, 0.5F, 1e-30F), -1.0F);
}

TEST(ShadeIso, LambertByTheGradient) {
  TestMedium medium({64, 64, 64}, 16, 1, 1.0F, [](const Float3& p) { return p.x / 64; });
  Lighting lighting;
  lighting.zenith = lighting.horizon = lighting.ground = {0, 0, 0};
  lighting.background = {9, 9, 9};
  lighting.sky_behind = false;
  lighting.light_count = 1;
  lighting.lights[0] = {normalised(Float3{-1, 0, 1}, {}), {kPi, kPi, kPi}};
  const Float3 seen = shade_iso(*medium, lighting, {-5, 32, 32}, {1, 0, 0}, 0.5F, {1, 0.5F, 0.25F}, 0.5F);
  EXPECT_NEAR(seen.x, std::sqrt(0.5F), 1e-3F);
  EXPECT_NEAR(seen.y, 0.5F * std::sqrt(0.5F), 1e-3F);
  EXPECT_EQ(shade_iso(*medium, lighting, {-5, 32, 32}, {1, 0, 0}, 2, {1, 1, 1}, 0.5F), lighting.background);
}

}  // namespace
}  // namespace weir::iso_surface_test
