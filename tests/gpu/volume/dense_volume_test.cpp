#include "gpu/volume/dense_volume.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "gpu/render/backend.h"
#include "gpu/volume/leaf_table.h"
#include "tests/stock/test_grid.h"

namespace weir::dense_volume_test {
namespace {

using test::TestGrid;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

float noise(const Index3& i) {
  return Random(1, static_cast<std::uint64_t>(i.x * 1000003 + i.y * 1009 + i.z), 5).uniform() - 0.25F;
}

DenseVolume dense(const Box& box, const std::function<float(const Index3&)>& value, float background = 0) {
  auto values = std::make_unique<float[]>(static_cast<std::size_t>(box.voxels()));
  std::size_t k = 0;
  for (std::int64_t z = box.lo.z; z < box.hi.z; ++z) {
    for (std::int64_t y = box.lo.y; y < box.hi.y; ++y) {
      for (std::int64_t x = box.lo.x; x < box.hi.x; ++x) values[k++] = value({x, y, z});
    }
  }
  return {{box, {1, 1, 1}, {0, 0, 0}}, std::move(values), background};
}

TEST(DenseVolume, FiltersAsALeafTableDoes) {
  for (const Box& box : {Box{{-3, 2, 5}, {25, 24, 16}}, Box{{0, 0, 0}, {1, 1, 1}}, Box{{7, -9, 8}, {8, 20, 9}}}) {
    const TestGrid grid(box, noise);
    const LeafTable table(grid.grid());
    const DenseVolume volume = dense(box, noise);
    for (const Filter filter : {Filter::nearest, Filter::trilinear, Filter::stochastic}) {
      const VolumeSampler sparse{table.view(), filter};
      const DenseSampler sampler{volume.view(), filter};
      EXPECT_EQ(sampler.extent(), sparse.extent());
      for (std::uint64_t k = 0; k < 20000; ++k) {
        Random random(9, k, 0);
        const Float3 p{-2 + 32 * random.uniform(), -2 + 33 * random.uniform(), -2 + 15 * random.uniform()};
        Random a(3, k, 0);
        Random b(3, k, 0);
        ASSERT_EQ(sampler.sample(p, a), sparse.sample(p, b)) << p.x << ' ' << p.y << ' ' << p.z;
        ASSERT_EQ(sampler.smooth(p), sparse.smooth(p));
      }
    }
  }
}

TEST(DenseVolume, RangeOfTheFiniteValues) {
  const Box box{{0, 0, 0}, {3, 2, 1}};
  const auto range = [&](std::vector<float> values) {
    return dense(
               box, [&](const Index3& i) { return values[static_cast<std::size_t>(i.x + 3 * i.y)]; }, 7)
        .range();
  };
  EXPECT_EQ(range({1, -2, kNaN, 5, kInfinity, -kInfinity}).min, -2);
  EXPECT_EQ(range({1, -2, kNaN, 5, kInfinity, -kInfinity}).max, 5);
  EXPECT_EQ(range({-3e38F, 3e38F, 0, 0, 0, 0}).min, -3e38F);
  EXPECT_EQ(range({kNaN, kNaN, kNaN, kNaN, kInfinity, kNaN}).min, 7) << "none: the background";
  EXPECT_EQ(range({kNaN, kNaN, kNaN, kNaN, kInfinity, kNaN}).max, 7);
}

// Bounds by their definition: the cell, a voxel around it, the background outside the domain.
TEST(DenseVolume, MacrocellsBoundEveryLookup) {
  const Box box{{-3, 2, 5}, {45, 50, 16}};
  const auto value = [](const Index3& i) { return i.x == 4 ? kNaN : noise(i); };
  const float background = 3;
  const DenseVolume volume = dense(box, value, background);
  for (const std::int64_t edge : {std::int64_t{16}, std::int64_t{20}, std::int64_t{64}}) {
    const MacrocellGrid cells = macrocells_of(volume, edge);
    const std::int64_t dim = edge == 20 ? 32 : edge;
    EXPECT_EQ(cells.lattice().edge, static_cast<float>(dim));
    const NodeLattice lattice = make_lattice(box, dim);
    ASSERT_EQ(static_cast<std::int64_t>(cells.bounds().size()), lattice.size());
    for (std::int64_t c = 0; c < lattice.size(); ++c) {
      MinMax expected{kInfinity, -kInfinity};
      for_each_index(grown(lattice.node_box(lattice.position(c)), 1), [&](const Index3& i) {
        const float v = box.contains(i) ? value(i) : background;
        if (!std::isfinite(v)) return;
        expected.min = std::min(expected.min, v);
        expected.max = std::max(expected.max, v);
      });
      EXPECT_EQ(cells.bounds()[static_cast<std::size_t>(c)].min, expected.min) << edge << ' ' << c;
      EXPECT_EQ(cells.bounds()[static_cast<std::size_t>(c)].max, expected.max) << edge << ' ' << c;
    }
  }
}

TEST(DenseVolume, CellsWithoutAFiniteValueHoldTheBackground) {
  const DenseVolume volume = dense(
      {{0, 0, 0}, {64, 64, 64}}, [](const Index3&) { return kNaN; }, 2.5F);
  const MacrocellGrid cells = macrocells_of(volume, 16);
  for (const MinMax& bounds : cells.bounds()) {
    EXPECT_EQ(bounds.min, 2.5F);
    EXPECT_EQ(bounds.max, 2.5F);
  }
}

TEST(DenseVolume, RendersOnTheCpu) {
  const auto volume = std::make_shared<const DenseVolume>(dense({{0, 0, 0}, {20, 20, 20}}, noise));
  const auto backend = make_cpu_backend(1);
  const auto loaded = backend->load_dense(volume, 0);
  EXPECT_EQ(loaded->load_summary().way, "memory");
  EXPECT_EQ(loaded->load_summary().bytes, 32000U);
  EXPECT_EQ(loaded->info().range.min, volume->range().min);
  RenderOptions options;
  options.width = 8;
  options.height = 6;
  Scene scene;
  scene.mode = RenderMode::mip;
  const Picture picture = backend->render(*loaded, scene, options, {});
  EXPECT_EQ(picture.image.width, 8);
  EXPECT_GT(max_component(picture.image.at(4, 3)), 0.0F);
}

}  // namespace
}  // namespace weir::dense_volume_test
