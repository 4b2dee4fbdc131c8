#include "compressor/encode/macrocell_builder.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "format/nanovdb/macrocells.h"
#include "tests/compressor/support/converted.h"

namespace weir::macrocell_builder_test {
namespace {

using test::bits_of;
using test::Converted;
using test::MemoryVolume;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

// Finds the bounds by reading every voxel in reach. Outside the domain the background counts.
MinMax bounds_by_reading(const NvdbGrid& grid, const Box& domain, const Box& cell) {
  const Index3 apron{1, 1, 1};
  const Box reach{cell.lo - apron, cell.hi + apron};
  MinMax bounds = kNoBounds;
  const Box inside = intersect(reach, domain);
  for (std::int64_t n = 0; n < inside.voxels(); ++n) {
    const float v = grid.value(inside.lo + index_at(n, inside.extent()));
    if (v < bounds.min) bounds.min = v;
    if (v > bounds.max) bounds.max = v;
  }
  if (inside != reach || bounds.min > bounds.max) widen(bounds, {grid.background(), grid.background()});
  return bounds;
}

void expect_tight_bounds(const Converted& converted) {
  const NvdbGrid grid = converted.grid();
  const MacrocellView view = grid.macrocells();
  const Box domain = grid.index_bbox();
  ASSERT_EQ(view.cell, 16);
  ASSERT_EQ(view.apron, 1);
  ASSERT_EQ(static_cast<std::int64_t>(view.cells.size()), view.lattice.size());
  for (std::int64_t i = 0; i < view.lattice.size(); ++i) {
    const Box cell = view.lattice.node_box(view.lattice.position(i));
    const MinMax expected = bounds_by_reading(grid, domain, cell);
    const MinMax& found = view.cells[static_cast<std::size_t>(i)];
    ASSERT_EQ(found.min, expected.min) << cell.lo.x << ' ' << cell.lo.y << ' ' << cell.lo.z;
    ASSERT_EQ(found.max, expected.max) << cell.lo.x << ' ' << cell.lo.y << ' ' << cell.lo.z;
    // No value that a filter can reach lies outside the bounds, including inactive tiles beyond the domain.
    const Box reach{cell.lo - Index3{1, 1, 1}, cell.hi + Index3{1, 1, 1}};
    for (std::int64_t n = 0; n < reach.voxels(); ++n) {
      const float v = grid.value(reach.lo + index_at(n, reach.extent()));
      ASSERT_FALSE(v < found.min || v > found.max);
    }
  }
}

class MacrocellTest : public testing::TestWithParam<Box> {};

TEST_P(MacrocellTest, BoundsEveryVoxelInReachTightly) {
  std::mt19937 random(9);
  for (const bool sparse : {true, false}) {
    MemoryVolume volume(GetParam(), [&](const Index3& i) {
      const bool hot = random() % 50 == 0;
      const float noise = static_cast<float>(random() % 2001) * 0.001F - 1;
      return sparse && !hot ? 0.5F : noise * static_cast<float>(1 + (i.x & 31));
    });
    ConversionOptions options;
    for (const FillMode fill : {FillMode::mean, FillMode::background}) {
      options.fill = fill;
      const std::uint64_t minimum = test::minimum_size(volume, options);
      expect_tight_bounds(test::convert_to(volume, options, minimum));
      expect_tight_bounds(test::convert_to(volume, options, minimum + 50'000));
      expect_tight_bounds(test::convert_to(volume, options, minimum + 200'000));
      if (HasFailure()) return;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Domains, MacrocellTest,
                         testing::Values(Box{{0, 0, 0}, {16, 16, 16}}, Box{{0, 0, 0}, {1, 1, 1}},
                                         Box{{0, 0, 0}, {17, 33, 8}}, Box{{-20, -5, 3}, {40, 30, 50}},
                                         Box{{100, 100, 100}, {160, 140, 150}}, Box{{120, 0, 120}, {136, 20, 140}},
                                         Box{{-140, 0, 0}, {20, 9, 9}}, Box{{0, -130, 0}, {9, 140, 9}},
                                         Box{{0, 0, -260}, {9, 20, 140}}, Box{{4090, -4, 0}, {4106, 5, 17}}),
                         [](const auto& parameter) { return "Domain" + std::to_string(parameter.index); });

TEST(Macrocells, IgnoreNaNAndHoldInfinity) {
  const float inf = std::numeric_limits<float>::infinity();
  MemoryVolume volume({{0, 0, 0}, {64, 20, 20}}, [&](const Index3& i) {
    return i.x < 20 ? kNaN : i == Index3{60, 3, 3} ? inf : i.x % 3 == 0 ? kNaN : static_cast<float>(i.y);
  });
  ConversionOptions options;
  options.non_finite = NonFinitePolicy::keep;
  options.budget.kind = Budget::Kind::lossless;
  expect_tight_bounds(test::convert(volume, options));
}

TEST(Macrocells, BytesDoNotDependOnTheOrderOfRegions) {
  // Two regions that meet in the reach of one cell. One region has zeros of both signs.
  const Box domain{{0, 0, 0}, {256, 8, 8}};
  std::vector<std::uint32_t> low_bits;
  for (const bool left_first : {true, false}) {
    MacrocellBuilder builder(domain, 1.0F);
    builder.begin_layers(0, 1);
    RegionCells left({0, 0, 0});
    left.add_tile({{0, 0, 0}, {128, 8, 8}}, 0.0F);
    RegionCells right({1, 0, 0});
    right.add_tile({{128, 0, 0}, {256, 8, 8}}, -0.0F);
    builder.merge(left_first ? left : right);
    builder.merge(left_first ? right : left);
    std::int64_t first = 0;
    for (const MinMax& cell : builder.take_finished(true, first)) low_bits.push_back(bits_of(cell.min));
  }
  ASSERT_EQ(low_bits.size(), 32U);
  for (std::size_t i = 0; i < 16; ++i) EXPECT_EQ(low_bits[i], low_bits[i + 16]) << i;
}

TEST(Macrocells, AreTheSameHoweverManyLayersOfRegionsTheWindowHas) {
  const Box domain{{-5, 3, -140}, {30, 40, 500}};
  const auto cells_of = [&](const std::vector<std::int64_t>& layers) {
    MacrocellBuilder builder(domain, 0.5F);
    std::vector<MinMax> all;
    std::int64_t z = -2;  // the first layer of regions
    for (const std::int64_t count : layers) {
      builder.begin_layers(z, count);
      for (const std::int64_t end = z + count; z < end; ++z) {
        for (std::int64_t x = -1; x < 1; ++x) {
          const Index3 region{x, 0, z};
          const Box voxels = intersect({region * kLowerDim, (region + Index3{1, 1, 1}) * kLowerDim}, domain);
          RegionCells cells(region);
          cells.add_tile(voxels, static_cast<float>(z + 100 * x));
          builder.merge(cells);
        }
      }
      std::int64_t first = 0;
      const std::vector<MinMax> finished = builder.take_finished(z == 4, first);
      EXPECT_EQ(first, static_cast<std::int64_t>(all.size()) / (builder.lattice().count.x * builder.lattice().count.y));
      all.insert(all.end(), finished.begin(), finished.end());
    }
    return all;
  };
  const std::vector<MinMax> one_by_one = cells_of({1, 1, 1, 1, 1, 1});
  ASSERT_EQ(one_by_one.size(), 3U * 3U * 41U);
  for (const std::vector<std::int64_t>& layers : {std::vector<std::int64_t>{6}, {1, 3, 2}, {4, 2}}) {
    const std::vector<MinMax> other = cells_of(layers);
    ASSERT_EQ(other.size(), one_by_one.size());
    EXPECT_EQ(std::memcmp(other.data(), one_by_one.data(), other.size() * sizeof(MinMax)), 0) << layers.size();
  }
}

}  // namespace
}  // namespace weir::macrocell_builder_test
