// The environment in the tracers: the two ways of sampling its light together count all of it exactly once, and are
// less noisy than either alone.
#include <gtest/gtest.h>

#include <cmath>

#include "gpu/trace/iso_surface.h"
#include "gpu/trace/path_tracer.h"
#include "gpu/trace/ray_march.h"
#include "tests/gpu/support/test_environment.h"
#include "tests/gpu/support/test_medium.h"

namespace weir::environment_light_test {
namespace {

using test::Estimate;
using test::estimate;
using test::TestMedium;

constexpr double kSigmas = 4.5;  // allowed deviation of the mean

const auto kBlob = [](const Float3& p) {
  const Float3 d = p - Float3{16, 16, 16};
  return greater(0.0F, 1.0F - length(d) / 14.0F);
};

Lighting lit_by(const Environment& environment) {
  Lighting lighting;
  lighting.environment = environment.view();
  return lighting;
}

// A sky with a sun of `size` x `size` texels of 0.008 sr each, with red radiance `radiance`.
Environment sun(float radiance, int size) {
  return {test::surroundings(
              32,
              [=](int x, int y) {
                const bool in_sun = x >= 40 && x < 40 + size && y >= 9 && y < 9 + size;
                return in_sun ? Float3{radiance, 0.8F * radiance, 0.6F * radiance} : Float3{0.2F, 0.3F, 0.4F};
              }),
          {},
          "sun"};
}

// Follows paths that end in the environment, unweighted and without drawing light: what scattering alone finds.
template <class Volume>
double by_scattering(const Medium<Volume>& medium, const Lighting& lighting, const Float3& eye, Float3 direction,
                     int max_bounces, Random& random) {
  double weight = 1;
  Ray ray = medium.ray(eye, direction);
  for (int bounce = 0;; ++bounce) {
    const float length = enter(ray, medium.shown);
    const Flight flight = length > 0 ? delta_track(medium, ray, length, RayKind::camera, random) : Flight{};
    if (flight.end == FlightEnd::escaped) {
      return weight * static_cast<double>((bounce == 0 ? lighting.behind(direction) : lighting.sky(direction)).x);
    }
    weight *= static_cast<double>(medium.albedo);
    if (bounce == max_bounces) return 0;
    const float u = random.uniform();
    direction = sample_phase(direction, medium.g, u, random.uniform());
    ray = medium.ray(ray.at(flight.t), direction);
  }
}

TEST(EnvironmentLight, WhiteFurnace) {
  const Environment environment = test::even(8, 1);
  const Lighting lighting = lit_by(environment);
  for (const float g : {0.0F, 0.6F, -0.4F, 0.99F}) {
    for (const float density : {0.05F, 0.5F}) {
      TestMedium medium({32, 32, 32}, 16, density, 1.0F, kBlob);
      medium->g = g;
      const Estimate radiance = estimate(20000, [&](Random& random) {
        return trace_path(*medium, lighting, {-4, 15, 1}, {0.8F, 0, 0.6F}, 1 << 20, random).y;
      });
      EXPECT_NEAR(radiance.mean, 1.0, kSigmas * radiance.sigma + 1e-6) << g << ' ' << density;
    }
  }
}

TEST(EnvironmentLight, EvenSurroundingsAreAmbientLight) {
  const Environment environment = test::even(16, 0.75F);
  Lighting ambient;
  ambient.zenith = ambient.horizon = ambient.ground = {0.75F, 0.75F, 0.75F};
  const Lighting lighting = lit_by(environment);
  TestMedium medium({32, 32, 32}, 16, 0.8F, 1.0F, kBlob);
  medium->albedo = 0.7F;
  medium->g = 0.5F;
  for (const int bounces : {0, 1, 3, 1 << 20}) {
    const auto trace = [&](const Lighting& light) {
      return estimate(100000, [&](Random& random) {
        return trace_path(*medium, light, {-5, 15, 17}, {1, 0, 0}, bounces, random).x;
      });
    };
    const Estimate a = trace(ambient);
    const Estimate b = trace(lighting);
    EXPECT_NEAR(a.mean, b.mean, kSigmas * std::hypot(a.sigma, b.sigma)) << bounces;
    EXPECT_LT(a.mean, 0.75);
  }
}

// The soft sun tests the mean, which scattering alone finds to some percent. The bright sun tests the variance.
TEST(EnvironmentLight, AgreesWithScatteringAloneAndIsLessNoisy) {
  const Environment soft = sun(30, 4);
  const Environment bright = sun(5000, 1);
  for (const Environment* environment : {&soft, &bright}) {
    const Lighting lighting = lit_by(*environment);
    for (const float g : {0.0F, 0.8F, -0.5F}) {
      for (const int bounces : {1, 1 << 20}) {
        TestMedium medium({32, 32, 32}, 16, 0.3F, 1.0F, kBlob);
        medium->albedo = 0.9F;
        medium->g = g;
        const Float3 eye{-40, 10, 16};
        const Float3 direction = normalised(Float3{1, 0.1F, 0.02F}, {1, 0, 0});
        const Estimate alone = estimate(
            400000, [&](Random& random) { return by_scattering(*medium, lighting, eye, direction, bounces, random); });
        const Estimate both = estimate(
            100000, [&](Random& random) { return trace_path(*medium, lighting, eye, direction, bounces, random).x; });
        EXPECT_NEAR(alone.mean, both.mean, kSigmas * std::hypot(alone.sigma, both.sigma)) << g << ' ' << bounces;
        if (environment == &soft) {
          EXPECT_LT(alone.sigma, 0.03 * alone.mean);
        }
        const double variance_ratio = 4 * alone.sigma * alone.sigma / (both.sigma * both.sigma);
        EXPECT_GT(variance_ratio, environment == &soft ? 2 : 100) << g << ' ' << bounces;
      }
    }
  }
}

// Scattering is so far forward that directions drawn by the light are poor. The noise is at most twice that of
// scattering alone.
TEST(EnvironmentLight, SharpScatteringUnderSoftLight) {
  const Environment environment(test::surroundings(16,
                                                   [](int x, int y) {
                                                     return Float3{1.0F + static_cast<float>(x + y) / 48, 1, 1};
                                                   }),
                                {}, "");
  const Lighting lighting = lit_by(environment);
  TestMedium medium({32, 32, 32}, 16, 0.3F, 1.0F, kBlob);
  medium->g = 0.97F;
  const Float3 eye{-40, 10, 16};
  const Estimate alone = estimate(100000, [&](Random& random) {
    return by_scattering(*medium, lighting, eye, {1, 0, 0}, 1 << 20, random);
  });
  const Estimate both = estimate(100000, [&](Random& random) {
    return trace_path(*medium, lighting, eye, {1, 0, 0}, 1 << 20, random).x;
  });
  EXPECT_NEAR(alone.mean, both.mean, kSigmas * std::hypot(alone.sigma, both.sigma));
  EXPECT_LT(both.sigma, 2 * alone.sigma + 0.01);
}

TEST(EnvironmentLight, AddsToDirectionalLights) {
  const Environment environment = test::even(4, 0.5F);
  Lighting lighting = lit_by(environment);
  Lighting ambient;
  ambient.zenith = ambient.horizon = ambient.ground = {0.5F, 0.5F, 0.5F};
  for (Lighting* light : {&lighting, &ambient}) {
    light->lights[0] = {{0, 0, 1}, {5, 5, 5}};
    light->light_count = 1;
  }
  TestMedium medium({32, 32, 32}, 16, 0.3F, 1.0F, kBlob);
  medium->albedo = 0.9F;
  const auto trace = [&](const Lighting& light) {
    return estimate(100000, [&](Random& random) {
      return trace_path(*medium, light, {-5, 15, 17}, {1, 0, 0}, 1 << 20, random).x;
    });
  };
  const Estimate a = trace(ambient);
  const Estimate b = trace(lighting);
  EXPECT_NEAR(a.mean, b.mean, kSigmas * std::hypot(a.sigma, b.sigma));
}

// The picture may have rows without light and texels that are never drawn.
TEST(EnvironmentLight, HardPicturesGiveFiniteRadiance) {
  const Environment environment(test::surroundings(2,
                                                   [](int x, int y) {
                                                     if (y == 1) return Float3{};
                                                     return x == 0 ? Float3{1e30F, 0, 0} : Float3{0, 0, 1e-40F};
                                                   }),
                                {}, "");
  const Lighting lighting = lit_by(environment);
  TestMedium medium({32, 32, 32}, 16, 0.5F, 1.0F, kBlob);
  for (std::uint32_t i = 0; i < 20000; ++i) {
    Random random(3, 4, i);
    const Float3 c = trace_path(*medium, lighting, {16, 16, 40}, {0, 0, -1}, 64, random);
    ASSERT_TRUE(is_finite(c.x) && is_finite(c.y) && is_finite(c.z));
  }
}

TEST(EnvironmentLight, TheCameraSeesItOnlyWhenAsked) {
  const Environment environment = sun(5000, 1);
  Lighting lighting = lit_by(environment);
  const Float3 ahead{1, 0, 0};
  TestMedium empty({16, 16, 16}, 16, 1, 0.0F, [](const Float3&) { return 0.0F; });
  Random random(1, 2, 3);
  const auto seen = [&] { return trace_path(*empty, lighting, {-1, 8, 8}, ahead, 9, random); };
  EXPECT_EQ(seen(), (Float3{0.2F, 0.3F, 0.4F}));
  EXPECT_EQ(march(*empty, lighting, {-1, 8, 8}, ahead, 0.5F, 0, random), (Float3{0.2F, 0.3F, 0.4F}));
  lighting.sky_behind = false;
  lighting.background = {0, 0.5F, 1};
  EXPECT_EQ(seen(), (Float3{0, 0.5F, 1}));
}

// A wall that faces the camera is lit by the mean of the light over its hemisphere.
TEST(EnvironmentLight, SurfacesReflectTheMeanOfTheirHemisphere) {
  const Environment environment(test::surroundings(64,
                                                   [](int x, int) {
                                                     return x < 32 || x >= 96 ? Float3{1, 1, 1} : Float3{};
                                                   }),
                                {}, "");
  Lighting lighting = lit_by(environment);  // light from behind, -x
  const auto wall = [](const Float3& p) { return clamped((p.x - 15.5F), 0.0F, 1.0F); };
  TestMedium medium({32, 32, 32}, 16, 1, 1.0F, wall);
  EXPECT_NEAR(shade_iso(*medium, lighting, {-1, 16, 16}, {1, 0, 0}, 0.5F, {1, 0.5F, 1}, 0.5F).y, 0.5, 0.005);
  EXPECT_NEAR(shade_iso(*medium, lighting, {33, 16, 16}, {-1, 0, 0}, 0.5F, {1, 0.5F, 1}, 0.5F).y, 0, 0.005);
}

}  // namespace
}  // namespace weir::environment_light_test
