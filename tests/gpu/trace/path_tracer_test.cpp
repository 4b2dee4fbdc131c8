#include "gpu/trace/path_tracer.h"

#include <gtest/gtest.h>

#include <cmath>

#include "gpu/trace/ray_march.h"
#include "tests/gpu/support/test_medium.h"

namespace weir::path_tracer_test {
namespace {

using test::Estimate;
using test::estimate;
using test::TestMedium;

constexpr double kSigmas = 4.5;  // allowed deviation of the mean

const auto kHalf = [](const Float3&) { return 0.5F; };
const auto kBlob = [](const Float3& p) {
  const Float3 d = p - Float3{16, 16, 16};
  return greater(0.0F, 1.0F - length(d) / 14.0F);
};

// In surroundings of radiance 1 everything that does not absorb is invisible.
TEST(TracePath, WhiteFurnace) {
  const Lighting ambient;
  for (const float g : {0.0F, 0.6F, -0.4F}) {
    for (const float density : {0.05F, 0.5F}) {
      TestMedium medium({32, 32, 32}, 16, density, 1.0F, kBlob);
      medium->g = g;
      const Estimate radiance = estimate(20000, [&](Random& random) {
        return trace_path(*medium, ambient, {-40, 10, 16}, {1, 0.1F, 0}, 1 << 20, random).y;
      });
      EXPECT_NEAR(radiance.mean, 1.0, kSigmas * radiance.sigma + 1e-6) << g << ' ' << density;
    }
  }
}

// Absorption alone: the background through the slab, by Beer-Lambert.
TEST(TracePath, PureAbsorptionIsBeerLambert) {
  TestMedium medium({64, 16, 16}, 16, 0.05F, 1.0F, kHalf);
  medium->albedo = 0;
  Lighting lighting;
  lighting.sky_behind = false;
  lighting.background = {2, 1, 0.5F};
  const Estimate radiance = estimate(100000, [&](Random& random) {
    return trace_path(*medium, lighting, {-3, 8, 8}, {1, 0, 0}, 100, random).x;
  });
  EXPECT_NEAR(radiance.mean, 2 * std::exp(-0.025 * 64), kSigmas * radiance.sigma);
}

// With albedo 0 and emission 1, both renderers integrate emission and absorption over a background.
TEST(TracePath, AgreesWithRayMarchingWithoutScattering) {
  TestMedium medium({32, 32, 32}, 16, 0.2F, 1.0F, kBlob);
  medium->albedo = 0;
  medium->emission = 1;
  Lighting lighting;
  lighting.sky_behind = false;
  lighting.background = {0.25F, 0.25F, 0.25F};
  const Float3 eye{-20, 12, 18};
  const Float3 direction = normalised(Float3{1, 0.1F, -0.05F}, {1, 0, 0});
  const Estimate path =
      estimate(200000, [&](Random& random) { return trace_path(*medium, lighting, eye, direction, 100, random).x; });
  const Estimate dvr =
      estimate(2000, [&](Random& random) { return march(*medium, lighting, eye, direction, 0.05F, 0, random).x; });
  EXPECT_NEAR(path.mean, dvr.mean, kSigmas * std::hypot(path.sigma, dvr.sigma) + 1e-3);
  EXPECT_GT(path.mean, 0.5);
}

// One collision in a thin slab: L = albedo irradiance phase tau, to first order in tau.
TEST(TracePath, SingleScatteringOfADirectionalLight) {
  TestMedium medium({16, 16, 16}, 16, 2e-4F, 1.0F, [](const Float3&) { return 1.0F; });
  medium->albedo = 0.8F;
  medium->g = 0.3F;
  Lighting lighting;
  lighting.zenith = lighting.horizon = lighting.ground = {0, 0, 0};
  lighting.lights[0] = {{0, 0, 1}, {5, 5, 5}};
  lighting.light_count = 1;
  const Estimate radiance = estimate(2000000, [&](Random& random) {
    return trace_path(*medium, lighting, {-1, 8, 8}, {1, 0, 0}, 1, random).x;
  });
  const double phase_90 = static_cast<double>(phase(0, 0.3F));
  EXPECT_NEAR(radiance.mean, 0.8 * 5 * phase_90 * 16 * 2e-4, kSigmas * radiance.sigma + 1e-6);
}

// Russian roulette changes the noise, not the mean. A medium of albedo 0.9 in surroundings of 1 is dimmer than
// the surroundings by exactly what the bounces lose.
TEST(TracePath, RouletteIsUnbiased) {
  TestMedium dense({32, 32, 32}, 16, 2, 1.0F, [](const Float3&) { return 1.0F; });
  dense->albedo = 0.9F;
  const Lighting ambient;
  const Float3 eye{-5, 16, 16};
  // Expected radiance without roulette: the sum over n of P(n collisions) albedo^n.
  const Estimate counted = estimate(40000, [&](Random& random) {
    double weight = 1;
    Float3 direction{1, 0, 0};
    Ray ray = dense->ray(eye, direction);
    for (;;) {
      const float length = enter(ray, dense->shown);
      const Flight flight = length > 0 ? delta_track(*dense, ray, length, RayKind::camera, random) : Flight{};
      if (flight.end != FlightEnd::collided) return weight;
      weight *= 0.9;
      const float u = random.uniform();
      direction = sample_phase(direction, 0, u, random.uniform());
      ray = dense->ray(ray.at(flight.t), direction);
    }
  });
  const Estimate traced = estimate(200000, [&](Random& random) {
    return trace_path(*dense, ambient, eye, {1, 0, 0}, 1 << 20, random).z;
  });
  EXPECT_NEAR(traced.mean, counted.mean, kSigmas * std::hypot(traced.sigma, counted.sigma));
}

TEST(TracePath, NoBouncesIsBackgroundAndBlack) {
  TestMedium medium({16, 16, 16}, 16, 1e6F, 1.0F, [](const Float3&) { return 1.0F; });
  const Lighting ambient;
  Random random(1, 2, 3);
  EXPECT_EQ(trace_path(*medium, ambient, {-1, 8, 8}, {1, 0, 0}, 0, random), (Float3{0, 0, 0}));
  EXPECT_EQ(trace_path(*medium, ambient, {-1, 8, 8}, {-1, 0, 0}, 0, random), (Float3{1, 1, 1}));
}

// A path without scattering has one collision, which emits. Each scattering leads to one more collision.
TEST(TracePath, EveryCollisionEmits_AlsoBehindTheLastScattering) {
  TestMedium medium({32, 32, 32}, 16, 1e6F, 1.0F, [](const Float3&) { return 1.0F; });
  medium->emission = 2;
  Lighting lighting;
  lighting.zenith = lighting.horizon = lighting.ground = {0, 0, 0};
  for (int scatterings = 0; scatterings <= 6; ++scatterings) {
    Random random(1, 2, 3);
    const auto emitted = static_cast<float>(2 * (scatterings + 1));
    EXPECT_EQ(trace_path(*medium, lighting, {16, 16, 16}, {1, 0, 0}, scatterings, random),
              (Float3{emitted, emitted, emitted}));
  }
}

TEST(TracePath, CameraInsideAndOnBorders) {
  TestMedium medium({32, 32, 32}, 16, 0.1F, 1.0F, kHalf);
  const Lighting ambient;
  for (const Float3 eye : {Float3{16, 16, 16}, Float3{0, 0, 0}, Float3{32, 32, 32}, Float3{16, 0, 32}}) {
    for (const Float3 direction : {Float3{1, 0, 0}, Float3{0, -1, 0}, Float3{0, 0, 1}, Float3{0.6F, 0.8F, 0}}) {
      const Estimate radiance = estimate(
          5000, [&](Random& random) { return trace_path(*medium, ambient, eye, direction, 1 << 20, random).x; });
      EXPECT_NEAR(radiance.mean, 1.0, kSigmas * radiance.sigma + 1e-6);
    }
  }
}

}  // namespace
}  // namespace weir::path_tracer_test
