#include "gpu/volume/mean_pyramid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <tuple>
#include <vector>

#include "gpu/volume/voxel_memory.h"
#include "tests/stock/test_grid.h"
#include "tests/support/packed_sample.h"

namespace weir::mean_pyramid_test {
namespace {

using test::PackedSample;

constexpr Box kDomain{{-5, 120, 9}, {46, 145, 90}};
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

float noise(const Index3& i) {
  return Random(1, static_cast<std::uint64_t>((i.x + 999) * 1000003 + i.y * 1009 + i.z), 5).uniform() - 0.25F;
}

std::vector<float> values_of(const Box& domain, const std::function<float(const Index3&)>& value) {
  std::vector<float> values;
  for (std::int64_t z = domain.lo.z; z < domain.hi.z; ++z) {
    for (std::int64_t y = domain.lo.y; y < domain.hi.y; ++y) {
      for (std::int64_t x = domain.lo.x; x < domain.hi.x; ++x) values.push_back(value({x, y, z}));
    }
  }
  return values;
}

DenseView view_of(const std::vector<float>& values, const Box& domain) {
  const Index3 e = domain.extent();
  return {values.data(),
          {static_cast<std::int32_t>(e.x), static_cast<std::int32_t>(e.y), static_cast<std::int32_t>(e.z)}};
}

// Checks each texel against the finite voxels of the domain in its cube of edge 2^level. Cubes begin at the first
// region's corner.
void expect_means(const MeanPyramid& pyramid, const Box& domain, const std::function<float(const Index3&)>& value) {
  const LevelsView<DenseSampler> view = pyramid.view();
  const Index3 corner = floor_div(domain.lo, kRegionDim) * kRegionDim;
  for (int l = view.first; l < view.first + view.count; ++l) {
    const std::int64_t edge = std::int64_t{1} << l;
    std::map<std::tuple<std::int64_t, std::int64_t, std::int64_t>, std::pair<double, double>> sums;
    for_each_index(domain, [&](const Index3& i) {
      const Index3 cube = floor_div(i - corner, edge) - floor_div(domain.lo - corner, edge);
      auto& [sum, count] = sums[{cube.x, cube.y, cube.z}];
      if (!std::isfinite(value(i))) return;
      sum += static_cast<double>(value(i));
      count += 1;
    });
    const DenseView& texels = view.texels[l - view.first].table;
    ASSERT_EQ(sums.size(), static_cast<std::size_t>(texels.extent.x * texels.extent.y * texels.extent.z)) << l;
    for (const auto& [cube, mean] : sums) {
      const auto [x, y, z] = cube;
      const float found =
          texels.voxel({static_cast<std::int32_t>(x), static_cast<std::int32_t>(y), static_cast<std::int32_t>(z)});
      if (mean.second == 0) {
        ASSERT_TRUE(std::isnan(found)) << l << ": " << x << ' ' << y << ' ' << z;
      } else {
        ASSERT_NEAR(static_cast<double>(found), mean.first / mean.second,
                    1e-6 * (1 + std::abs(mean.first / mean.second)))
            << l << ": " << x << ' ' << y << ' ' << z;
      }
    }
  }
}

TEST(MeanPyramid, EveryTexel_IsTheMeanOfTheVoxelsInItsCube) {
  const std::vector<float> values = values_of(kDomain, noise);
  for (int first = 1; first <= kMostFinest; ++first) {
    const MeanPyramid pyramid(kDomain, view_of(values, kDomain), first, 2);
    EXPECT_EQ(pyramid.view().texels[pyramid.view().count - 1].table.extent, (Int3{1, 1, 1}));
    expect_means(pyramid, kDomain, noise);
  }
}

TEST(MeanPyramid, VoxelsThatAreNotFinite_AreLeftOut) {
  const auto value = [](const Index3& i) {
    if (i.x < 8) return kNaN;
    return (i.x + i.y + i.z) % 3 == 0 ? -std::numeric_limits<float>::infinity() : 7.5F;
  };
  const std::vector<float> values = values_of(kDomain, value);
  const MeanPyramid pyramid(kDomain, view_of(values, kDomain), 1, 1);
  for (const auto& [low, finite] : {std::pair{0, false}, std::pair{10, true}}) {
    const float found = pyramid.view().texels[0].table.voxel({low, 3, 3});
    EXPECT_EQ(std::isfinite(found), finite);
    if (finite) {
      EXPECT_EQ(found, 7.5F);
    }
  }
}

TEST(MeanPyramid, OfAGridsLeavesAndOfPackedBlocks_IsThatOfTheirVoxels) {
  const test::TestGrid made(kDomain, noise);
  const LeafTable leaves(made.grid());
  expect_means(MeanPyramid(kDomain, leaves.view(), 1, 2), kDomain, noise);

  const test::PackedFile packed = PackedSample::build();
  const NvdbGrid grid = NvdbGrid::open(packed.file, "a.nvdb");
  const LeafTable decoded(grid);
  const CachedBlocks cached(grid, kLeastCacheBytes);
  for (const int first : {1, 2, 3, 5}) {
    expect_means(MeanPyramid(PackedSample::kDomain, decoded.view(), first, 2), PackedSample::kDomain,
                 PackedSample::value);
    expect_means(MeanPyramid(PackedSample::kDomain, cached, first, 2), PackedSample::kDomain, PackedSample::value);
  }
}

// Values are trilinear between texels and linear between levels, so a linear function is reproduced on all levels.
TEST(LevelsView, ALinearFunction_IsTheSameOnEveryLevel) {
  const Box domain{{-8, 16, 0}, {56, 80, 64}};
  const auto value = [](const Index3& i) {
    return static_cast<float>(i.x) + 2.0F * static_cast<float>(i.y) - 0.5F * static_cast<float>(i.z);
  };
  const std::vector<float> values = values_of(domain, value);
  const MeanPyramid pyramid(domain, view_of(values, domain), 1, 1);
  for (const Float3& p : {Float3{32, 32, 32}, Float3{25.25F, 40, 31}, Float3{33, 30.5F, 20}}) {
    // Voxel i has its value at i + 0.5.
    const float expected = p.x - 8.5F + 2.0F * (p.y + 15.5F) - 0.5F * (p.z - 0.5F);
    for (const float level : {1.0F, 1.5F, 2.25F, 3.0F}) {
      EXPECT_NEAR(pyramid.view().at(p, level), expected, 1e-4F) << level;
    }
  }
  // Above the coarsest level nothing changes.
  EXPECT_EQ(pyramid.view().at({5, 5, 5}, 40), pyramid.view().at({60, 3, 9}, 40));
}

// Voxels 16 to 31 along x are 3, all others NaN. They are seen up to half a texel beyond.
TEST(LevelsView, FiniteTexelsBesideNaN_AreSeenInTheirWholeWidth) {
  const Box domain{{0, 0, 0}, {64, 64, 64}};
  const std::vector<float> values =
      values_of(domain, [](const Index3& i) { return i.x >= 16 && i.x < 32 ? 3.0F : kNaN; });
  const MeanPyramid pyramid(domain, view_of(values, domain), 1, 1);
  for (const float level : {1.0F, 2.0F, 3.0F}) {
    for (const float x : {16.1F, 17.0F, 20.3F, 24.0F, 29.0F, 31.9F}) {
      EXPECT_FLOAT_EQ(pyramid.view().at({x, 20, 30}, level), 3.0F) << level << ' ' << x;
    }
    const float half = std::exp2(level - 1);
    for (const float x : {0.0F, 15.9F - half, 32.1F + half, 64.0F}) {
      EXPECT_FALSE(std::isfinite(pyramid.view().at({x, 20, 30}, level))) << level << ' ' << x;
    }
  }
}

TEST(LevelChoice, CubesAreAsWideAsAPixel) {
  LevelChoice choice;
  choice.eye = {-100, 0, 0};
  choice.stretch = {1, 1, 4};
  choice.camera = std::log2(0.01F);  // a pixel's width at distance 1
  choice.scattered = choice.camera + 2;
  EXPECT_NEAR(choice.level({300, 0, 0}, RayKind::camera), 2, 1e-5F) << "400 away a pixel is 4 voxels wide";
  EXPECT_NEAR(choice.level({-100, 0, 200}, RayKind::camera), 3, 1e-5F) << "800 shortest edges";
  EXPECT_NEAR(choice.level({300, 0, 0}, RayKind::scattered), 4, 1e-5F);
}

TEST(LevelLattice, FinestLevel_FitsTheMemory) {
  const LevelLattice lattice{{0, 0, 0}, {256, 256, 256}};
  const std::uint64_t from_1 = level_bytes(lattice, 1);
  EXPECT_EQ(from_1, 4 * (128 * 128 * 128 + 64 * 64 * 64 + 32 * 32 * 32 + 16 * 16 * 16 + 512 + 64 + 8 + 1));
  EXPECT_EQ(finest_level_within(lattice, 1, from_1), 1);
  EXPECT_EQ(finest_level_within(lattice, 1, from_1 - 1), 2);
  EXPECT_EQ(finest_level_within(lattice, 3, from_1), 3);
  EXPECT_EQ(finest_level_within(lattice, 9, from_1), kMostFinest);
  EXPECT_EQ(finest_level_within(lattice, 1, 100), 0);
  // Also limited to a number of texels along an axis, and to 2^31 texels.
  EXPECT_EQ(finest_level_within(lattice, 1, from_1, 100), 2);
  EXPECT_EQ(finest_level_within({{0, 0, 0}, {4096, 4096, 4096}}, 1, std::uint64_t{1} << 40U), 2);
}

}  // namespace
}  // namespace weir::mean_pyramid_test
