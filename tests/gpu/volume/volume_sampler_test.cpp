#include "gpu/volume/volume_sampler.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "tests/gpu/support/test_medium.h"
#include "tests/stock/test_grid.h"

namespace weir::volume_sampler_test {
namespace {

using test::estimate;
using test::TestGrid;

// A hash as the value: it has no structure that could hide a wrong index.
float noise(const Index3& i) {
  return Random(1, static_cast<std::uint64_t>(i.x * 1000003 + i.y * 1009 + i.z), 5).uniform();
}

// The trilinear value by its definition, in double, read voxel by voxel through the grid's reader.
double reference(const NvdbGrid& grid, const Float3& p) {
  const Box box = grid.index_bbox();
  const std::array<double, 3> at{static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)};
  const Index3 e = box.extent();
  const std::array<std::int64_t, 3> extent{e.x, e.y, e.z};
  std::array<std::int64_t, 3> lower{};
  std::array<double, 3> f{};
  for (std::size_t a = 0; a < 3; ++a) {
    const double q = std::clamp(at[a] - 0.5, 0.0, static_cast<double>(extent[a] - 1));
    lower[a] = static_cast<std::int64_t>(q);
    f[a] = q - static_cast<double>(lower[a]);
  }
  double sum = 0;
  for (unsigned k = 0; k < 8; ++k) {
    double weight = 1;
    std::array<std::int64_t, 3> i{};
    for (unsigned a = 0; a < 3; ++a) {
      const bool up = (k >> a & 1U) != 0;
      weight *= up ? f[a] : 1 - f[a];
      i[a] = std::min(lower[a] + (up ? 1 : 0), extent[a] - 1);
    }
    sum += weight * static_cast<double>(grid.value(box.lo + Index3{i[0], i[1], i[2]}));
  }
  return sum;
}

class SamplerOnNoise : public testing::Test {
 protected:
  Float3 position(std::uint64_t k) const {
    Random random(9, k, 0);
    return {-2 + 32 * random.uniform(), -2 + 26 * random.uniform(), -2 + 15 * random.uniform()};
  }

  TestGrid grid_{{{-3, 2, 5}, {25, 24, 16}}, noise};
  LeafTable table_{grid_.grid()};
};

TEST_F(SamplerOnNoise, TrilinearIsItsDefinition) {
  const VolumeSampler sampler{table_.view(), Filter::trilinear};
  for (std::uint64_t k = 0; k < 20000; ++k) {
    const Float3 p = position(k);
    ASSERT_NEAR(static_cast<double>(sampler.smooth(p)), reference(grid_.grid(), p), 1e-5);
  }
}

TEST_F(SamplerOnNoise, TrilinearAtCentresIsTheVoxel) {
  const VolumeSampler sampler{table_.view(), Filter::trilinear};
  EXPECT_EQ(sampler.smooth({0.5F, 0.5F, 0.5F}), noise({-3, 2, 5}));
  EXPECT_EQ(sampler.smooth({27.5F, 21.5F, 10.5F}), noise({24, 23, 15}));
  EXPECT_EQ(sampler.smooth({5.5F, 7.5F, 3.5F}), noise({2, 9, 8}));
}

TEST(VolumeSampler, ValueAtACentre_IsTheVoxelThoughItsNeighbourIsNotANumber) {
  const Index3 hole{4, 4, 4};
  const TestGrid grid{{{0, 0, 0}, {8, 8, 8}},
                      [&](const Index3& i) { return i == hole ? std::numeric_limits<float>::quiet_NaN() : noise(i); }};
  const LeafTable table(grid.grid());
  const VolumeSampler sampler{table.view(), Filter::trilinear};
  const auto centre = [](std::int64_t i) { return static_cast<float>(i) + 0.5F; };
  for (std::int64_t z = 0; z < 8; ++z) {
    for (std::int64_t y = 0; y < 8; ++y) {
      for (std::int64_t x = 0; x < 8; ++x) {
        const Index3 i{x, y, z};
        if (i == hole) continue;
        ASSERT_EQ(sampler.value({centre(x), centre(y), centre(z)}), noise(i)) << x << ", " << y << ", " << z;
      }
    }
  }
  EXPECT_TRUE(std::isnan(sampler.value({4.5F, 4.5F, 4.5F})));
  EXPECT_TRUE(std::isnan(sampler.value({3.75F, 4.5F, 4.5F})));
  EXPECT_EQ(sampler.value({3.25F, 4.5F, 4.5F}), sampler.smooth({3.25F, 4.5F, 4.5F}));
}

TEST_F(SamplerOnNoise, NearestIsTheVoxelThatCoversThePosition) {
  const VolumeSampler sampler{table_.view(), Filter::nearest};
  EXPECT_EQ(sampler.smooth({0, 0, 0}), noise({-3, 2, 5}));
  EXPECT_EQ(sampler.smooth({0.999F, 0, 0}), noise({-3, 2, 5}));
  EXPECT_EQ(sampler.smooth({1, 0, 0}), noise({-2, 2, 5}));
}

TEST_F(SamplerOnNoise, PositionsOutsideAreClamped) {
  for (const Filter filter : {Filter::nearest, Filter::trilinear, Filter::stochastic}) {
    const VolumeSampler sampler{table_.view(), filter};
    Random random(1, 2, 3);
    EXPECT_EQ(sampler.sample({-100, -1e30F, -0.1F}, random), noise({-3, 2, 5}));
    EXPECT_EQ(sampler.sample({28, 22, 11}, random), noise({24, 23, 15}));
    EXPECT_EQ(sampler.sample({kInfinity, 1e30F, 11.1F}, random), noise({24, 23, 15}));
  }
}

TEST_F(SamplerOnNoise, NaNPositionReadsAVoxelInside) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const Filter filter : {Filter::nearest, Filter::trilinear, Filter::stochastic}) {
    Random random(1, 2, 3);
    EXPECT_EQ((VolumeSampler{table_.view(), filter}.sample({nan, nan, nan}, random)), noise({-3, 2, 5}));
  }
}

TEST_F(SamplerOnNoise, StochasticIsUnbiasedForTrilinear) {
  const VolumeSampler one_tap{table_.view(), Filter::stochastic};
  for (std::uint64_t k = 0; k < 50; ++k) {
    const Float3 p = position(k);
    const auto mean = estimate(20000, [&](Random& random) { return one_tap.sample(p, random); });
    EXPECT_NEAR(mean.mean, static_cast<double>(one_tap.smooth(p)), 4.5 * mean.sigma + 1e-6);
  }
}

TEST(Sampler, OneVoxelThick) {
  const TestGrid grid({{0, 0, 0}, {1, 1, 40}}, [](const Index3& i) { return static_cast<float>(i.z); });
  const LeafTable table(grid.grid());
  const VolumeSampler sampler{table.view(), Filter::trilinear};
  for (float z = 0.5F; z <= 39.5F; z += 0.25F) EXPECT_EQ(sampler.smooth({0.3F, 0.9F, z}), z - 0.5F);
  EXPECT_EQ(gradient(sampler, {0.5F, 0.5F, 20}), (Float3{0, 0, 1}));
}

// a + t (b - a) would overflow.
TEST(Sampler, HugeValuesOfBothSigns) {
  const TestGrid grid({{0, 0, 0}, {9, 9, 9}},
                      [](const Index3& i) { return (i.x + i.y + i.z) % 2 == 0 ? 3e38F : -3e38F; });
  const LeafTable table(grid.grid());
  const VolumeSampler sampler{table.view(), Filter::trilinear};
  for (float x = 0; x < 9; x += 0.125F) EXPECT_TRUE(is_finite(sampler.smooth({x, 4.7F, 8.3F}))) << x;
}

}  // namespace
}  // namespace weir::volume_sampler_test
