#include "gpu/scene/environment.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "format/base/error.h"
#include "tests/gpu/support/test_environment.h"

namespace weir::environment_test {
namespace {

using test::surroundings;

constexpr double kSphere = 4 * std::numbers::pi;

// A gray sky with a sun, black ground and black rows between them: every hard case of the tables.
Image hard_sky(std::int32_t height) {
  return surroundings(height, [&](std::int32_t x, std::int32_t y) -> Float3 {
    if (y > height / 2 || y == 3 || x == 2 * height - 1) return {};
    if (x == 5 && y == 2) return {4000, 3000, 2000};
    return {0.5F, 0.25F * static_cast<float>(x % 3), 1.0F + static_cast<float>(y)};
  });
}

Float3 at_angles(double polar, double azimuth) {
  return {static_cast<float>(std::sin(polar) * std::cos(azimuth)),
          static_cast<float>(std::sin(polar) * std::sin(azimuth)), static_cast<float>(std::cos(polar))};
}

std::string message(const Image& image, double scale = 1) {
  try {
    const Environment environment(image, {.scale = scale}, "sky.exr");
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    return error.what();
  }
  return "no error";
}

TEST(FindInterval, SkipsWhatIsEmpty) {
  const std::vector<std::uint32_t> bounds{0, 0, 5, 5, 5, kEnvironmentUnit, kEnvironmentUnit};
  const auto find = [&](std::uint32_t at) { return find_interval(bounds.data(), 6, at); };
  EXPECT_EQ(find(0), 1);
  EXPECT_EQ(find(4), 1);
  EXPECT_EQ(find(5), 4);
  EXPECT_EQ(find(kEnvironmentUnit - 1), 4);
}

TEST(Environment, TexelsCoverTheSphere) {
  for (const std::int32_t height : {1, 2, 3, 64, 4096}) {
    EnvironmentView view;
    view.width = 2 * height;
    view.height = height;
    double sum = 0;
    for (std::int32_t row = 0; row < height; ++row) sum += view.width * static_cast<double>(view.solid_angle(row));
    EXPECT_NEAR(sum, kSphere, 1e-6 * kSphere) << height;
  }
}

// Row 0 is around up, the centre column is at azimuth 0, and azimuth falls to the right.
TEST(Environment, DirectionsToTexels) {
  const Image image = surroundings(4, [](std::int32_t x, std::int32_t y) {
    return Float3{static_cast<float>(x), static_cast<float>(y), 1};
  });
  const double d = std::numbers::pi / 180;
  const Environment plain(image, {}, "");
  EXPECT_EQ(plain.view().at(at_angles(10 * d, 10 * d)), (Float3{3, 0, 1}));
  EXPECT_EQ(plain.view().at(at_angles(10 * d, -10 * d)), (Float3{4, 0, 1}));
  EXPECT_EQ(plain.view().at(at_angles(170 * d, 170 * d)), (Float3{0, 3, 1}));
  EXPECT_EQ(plain.view().at(at_angles(80 * d, -170 * d)), (Float3{7, 1, 1}));
  const Environment turned(image, {.rotation = 90}, "");
  EXPECT_EQ(turned.view().at(at_angles(80 * d, 80 * d)), (Float3{4, 1, 1}));
  // Up is y: azimuth 0 is +z, as for cameras, and up x ahead points along x.
  const Environment tilted(image, {.up = {0, 2, 0}, .scale = 3}, "");
  EXPECT_EQ(tilted.view().at({-0.1F, 0.2F, 0.9F}), (Float3{12, 3, 3}));
  EXPECT_EQ(tilted.view().at({0.1F, 0.2F, 0.9F}), (Float3{9, 3, 3}));
}

TEST(Environment, DensityIntegratesToOne) {
  for (const std::int32_t height : {1, 2, 8, 33}) {
    const Environment environment(height < 8 ? surroundings(height,
                                                            [](int x, int) {
                                                              return Float3{static_cast<float>(x), 0, 1};
                                                            })
                                             : hard_sky(height),
                                  {}, "");
    const EnvironmentView view = environment.view();
    double sum = 0;
    double light = 0;
    const int fine = 8;  // number of directions along the edge of a texel
    for (std::int32_t j = 0; j < fine * view.height; ++j) {
      const double step = std::numbers::pi / (fine * view.height);
      const double polar = (j + 0.5) * step;
      const double steradians = 2 * std::sin(polar) * std::sin(step / 2) * step;
      for (std::int32_t i = 0; i < fine * view.width; ++i) {
        const Float3 direction = at_angles(polar, std::numbers::pi - (i + 0.5) * step);
        sum += steradians * static_cast<double>(view.density(direction));
        light += steradians * static_cast<double>(view.at(direction).z);
      }
    }
    EXPECT_NEAR(sum, 1, 1e-5) << height;
    EXPECT_GT(light, 0);
  }
}

// Directions are drawn as often as the density says: a chi-square test over texels and within them.
TEST(Environment, DrawnDirectionsFollowTheDensity) {
  const Environment environment(hard_sky(12), {.up = {1, 2, -0.5}, .rotation = 33}, "");
  const EnvironmentView view = environment.view();
  const auto texels = static_cast<std::size_t>(view.width) * static_cast<std::size_t>(view.height);
  std::vector<double> counts(texels);
  constexpr int kDraws = 2000000;
  Random random(1, 2, 3);
  double mean = 0;  // mean of 1 / density: the solid angle of what can be drawn
  for (int i = 0; i < kDraws; ++i) {
    const EnvironmentSample s = view.sample(random);
    ASSERT_NEAR(length(s.direction), 1, 1e-5);
    ASSERT_GT(s.density, 0);
    // At a border between texels the rounded direction may belong to the neighbour.
    if (view.at(s.direction) == s.radiance) {
      ASSERT_FLOAT_EQ(view.density(s.direction), s.density);
    }
    const double polar = std::acos(std::clamp(static_cast<double>(dot(s.direction, view.up)), -1.0, 1.0));
    const double azimuth = std::atan2(dot(s.direction, view.left), dot(s.direction, view.ahead));
    const int row = std::clamp(static_cast<int>(polar / std::numbers::pi * view.height), 0, view.height - 1);
    const int column =
        std::clamp(static_cast<int>((0.5 - azimuth / 2 / std::numbers::pi) * view.width), 0, view.width - 1);
    ++counts[static_cast<std::size_t>(view.index(row, column))];
    mean += 1 / static_cast<double>(s.density) / kDraws;
  }
  double chi_square = 0;
  int cells = 0;
  double covered = 0;
  for (std::int32_t row = 0; row < view.height; ++row) {
    for (std::int32_t column = 0; column < view.width; ++column) {
      const double step = std::numbers::pi / view.height;
      const auto i = static_cast<std::size_t>(view.index(row, column));
      const double density =
          view.density(view.up * static_cast<float>(std::cos((row + 0.5) * step)) +
                       (view.ahead * static_cast<float>(std::cos(std::numbers::pi - (column + 0.5) * step)) +
                        view.left * static_cast<float>(std::sin(std::numbers::pi - (column + 0.5) * step))) *
                           static_cast<float>(std::sin((row + 0.5) * step)));
      const double expected = kDraws * density * static_cast<double>(view.solid_angle(row));
      if (expected == 0) {
        EXPECT_LE(counts[i], 3) << "black, but for directions on its border: " << row << ' ' << column;
        continue;
      }
      covered += static_cast<double>(view.solid_angle(row));
      if (expected < 5) continue;
      chi_square += (counts[i] - expected) * (counts[i] - expected) / expected;
      ++cells;
    }
  }
  EXPECT_GT(cells, 100);
  EXPECT_LT(std::abs(chi_square - cells), 4.5 * std::sqrt(2.0 * cells)) << cells;
  EXPECT_NEAR(mean, covered, 0.05 * covered);
}

// Uniform surroundings: azimuth and cosine of the polar angle of the drawn directions are uniform, up to the poles.
TEST(Environment, EvenSurroundingsAreDrawnEvenly) {
  for (const std::int32_t height : {1, 2, 5, 512}) {
    const Environment environment = test::even(height, 2);
    const EnvironmentView view = environment.view();
    std::vector<int> cosines(64);
    std::vector<int> azimuths(64);
    Random random(5, 6, 7);
    constexpr int kDraws = 640000;
    for (int i = 0; i < kDraws; ++i) {
      const EnvironmentSample s = view.sample(random);
      ASSERT_NEAR(s.density, 1 / kSphere, 1e-4 / kSphere);  // a row's probability is a multiple of 2^-31
      ASSERT_EQ(s.radiance, (Float3{2, 2, 2}));
      ++cosines[static_cast<std::size_t>(clamped((s.direction.z + 1) * 32, 0.0F, 63.5F))];
      ++azimuths[static_cast<std::size_t>(
          clamped((std::atan2(s.direction.y, s.direction.x) / kPi + 1) * 32, 0.0F, 63.5F))];
    }
    for (const auto& counts : {cosines, azimuths}) {
      double chi_square = 0;
      for (const int count : counts) chi_square += (count - 1e4) * (count - 1e4) / 1e4;
      EXPECT_LT(std::abs(chi_square - 63), 4.5 * std::sqrt(2.0 * 63)) << height;
    }
  }
}

TEST(Environment, PolesSeamsAndAxes) {
  const Environment environment(hard_sky(16), {}, "");
  const EnvironmentView view = environment.view();
  for (const float x : {-1.0F, -0.0F, 0.0F, 1.0F}) {
    for (const float y : {-1.0F, -1e-30F, -0.0F, 0.0F, 1e-30F, 1.0F}) {
      for (const float z : {-1.0F, 0.0F, 1.0F}) {
        const Float3 d = normalised({x, y, z}, {0, 0, 1});
        for (const Float3& v : {view.at(d), view.blended(d), view.on_surface(d)}) {
          EXPECT_TRUE(is_finite(v.x + v.y + v.z) && v.x >= 0 && v.y >= 0 && v.z >= 0);
        }
        EXPECT_TRUE(is_finite(view.density(d)) && view.density(d) >= 0);
      }
    }
  }
}

TEST(Environment, BlendedIsContinuousAcrossTheSeam) {
  const Environment environment(surroundings(2,
                                             [](int x, int) {
                                               return Float3{x == 0 ? 1.0F : (x == 3 ? 3.0F : 2.0F), 1, 1};
                                             }),
                                {}, "");
  const EnvironmentView view = environment.view();
  EXPECT_NEAR(view.blended({-1, 1e-6F, 0}).x, 2, 1e-4);   // half way between columns 0 and 3
  EXPECT_NEAR(view.blended({-1, -1e-6F, 0}).x, 2, 1e-4);  // from the other side
  const float half = std::sqrt(0.5F);
  EXPECT_NEAR(view.blended({-half, half, 0}).x, 1, 1e-4) << "the centre of a texel is the texel";
  EXPECT_NEAR(view.blended({-half, -half, 0}).x, 3, 1e-4);
}

// Light that the 9 terms hold exactly: L = a + b z + c x + d xy reflects a + 2/3 (b z + c x) + 1/4 d xy.
TEST(Environment, SurfacesReflectTheCosineWeightedMean) {
  const std::int32_t height = 256;
  const Environment environment(surroundings(height,
                                             [&](std::int32_t x, std::int32_t y) {
                                               const Float3 d =
                                                   at_angles((y + 0.5) * std::numbers::pi / height,
                                                             std::numbers::pi - (x + 0.5) * std::numbers::pi / height);
                                               return Float3{2 + d.z, 2 + d.x, 2 + d.x * d.y};
                                             }),
                                {}, "");
  for (const Float3 n : {Float3{0, 0, 1}, Float3{1, 0, 0}, Float3{0, -1, 0}, Float3{0.6F, 0.48F, 0.64F}}) {
    const Float3 reflected = environment.view().on_surface(n);
    EXPECT_NEAR(reflected.x, 2 + 2.0F / 3 * n.z, 1e-4);
    EXPECT_NEAR(reflected.y, 2 + 2.0F / 3 * n.x, 1e-4);
    EXPECT_NEAR(reflected.z, 2 + 0.25F * n.x * n.y, 1e-4);
  }
  // Half a sky: up gets all of it, the side half, down none.
  const Environment half(surroundings(64, [](int, int y) { return y < 32 ? Float3{1, 1, 1} : Float3{}; }), {}, "");
  EXPECT_NEAR(half.view().on_surface({0, 0, 1}).x, 1, 0.01);
  EXPECT_NEAR(half.view().on_surface({0, 1, 0}).x, 0.5, 0.01);
  EXPECT_NEAR(half.view().on_surface({0, 0, -1}).x, 0, 0.01);
}

TEST(Environment, Errors) {
  const Image even = surroundings(2, [](int, int) { return Float3{1, 1, 1}; });
  EXPECT_EQ(message(Image(4, 3)), "sky.exr: 4 x 3 pixels; a latitude-longitude picture is twice as wide as high");
  EXPECT_EQ(message(Image(0, 0)), "sky.exr: 0 x 0 pixels; a latitude-longitude picture is twice as wide as high");
  EXPECT_EQ(message(Image(8194, 4097)), "sky.exr: 8194 x 4097 pixels; scale it down to at most 8192 x 4096");
  EXPECT_EQ(message(Image(4, 2)),
            "sky.exr: the picture is black, at environment_scale 1; an environment must give light");
  EXPECT_EQ(message(even, 0), "sky.exr: the picture is black, at environment_scale 0; an environment must give light");
  Image bad = even;
  bad.pixels[6].y = -0.5F;
  bad.pixels[7].z = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(message(bad),
            "sky.exr: pixel (2, 1) is (1, -0.5, 1), and there are 2 such; radiance must be finite and not "
            "negative");
  bad = even;
  bad.pixels[0].x = kInfinity;
  EXPECT_EQ(message(bad),
            "sky.exr: pixel (0, 0) is (inf, 1, 1), and there are 1 such; radiance must be finite and not "
            "negative");
}

// Values up to the largest float, and denormals, make tables that draw the bright texels.
TEST(Environment, ExtremeRadiance) {
  for (const float radiance : {3e38F, 1e-45F}) {
    const Environment environment(
        surroundings(4,
                     [&](int x, int y) {
                       return x == 1 && y == 2 ? Float3{radiance, radiance, radiance} : Float3{};
                     }),
        {}, "");
    Random random(1, 1, 1);
    for (int i = 0; i < 100; ++i) {
      const EnvironmentSample s = environment.view().sample(random);
      EXPECT_EQ(s.radiance.x, lesser(radiance, 1e30F));
      EXPECT_FLOAT_EQ(s.density, 1 / environment.view().solid_angle(2));
    }
  }
}

}  // namespace
}  // namespace weir::environment_test
