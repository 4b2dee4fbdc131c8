#include "compressor/select/tree_regions.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace weir::tree_regions_test {
namespace {

TEST(TreeRegions, CoversTheDomainWithRegionsAndUppers) {
  for (const Box& domain : {Box{{0, 0, 0}, {1, 1, 1}}, Box{{0, 0, 0}, {128, 129, 4097}},
                            Box{{-4097, -1, 127}, {5, 300, 129}}, Box{{4095, 8, -8}, {4097, 9, 0}}}) {
    const TreeRegions tree(domain);
    std::int64_t voxels = 0;
    std::int64_t leaves = 0;
    std::vector<int> seen(tree.regions.size());
    tree.for_each_upper([&](std::int64_t u) {
      const Box upper = tree.upper_lattice.node_box(tree.upper_lattice.position(u));
      Index3 last{-1, -1, -1};
      tree.for_each_region_of(u, [&](std::int64_t r) {
        ++seen[static_cast<std::size_t>(r)];
        const Index3 at = tree.region_lattice.position(r);
        EXPECT_EQ(tree.upper_of(r), u);
        EXPECT_TRUE(upper.contains(tree.region_lattice.node_box(at)));
        const Index3 entry = tree.entry_of(r);
        EXPECT_EQ(upper.lo + entry * 128, tree.region_lattice.node_box(at).lo);
        EXPECT_GT(entry.x << 10 | entry.y << 5 | entry.z, last.x << 10 | last.y << 5 | last.z);
        last = entry;
        voxels += tree.region_lattice.voxels(at).voxels();
        const Box leaf_box = tree.leaf_box(r);
        leaves += leaf_box.voxels();
        for (std::int64_t n = 0; n < leaf_box.voxels(); ++n) {
          const Index3 leaf = leaf_box.lo + index_at(n, leaf_box.extent());
          const Index3 in = tree.leaves.node_box(leaf).lo - tree.region_lattice.node_box(at).lo;
          ASSERT_EQ(tree.mask_position(leaf), static_cast<std::size_t>(in.x / 8 * 256 + in.y / 8 * 16 + in.z / 8));
        }
      });
    });
    EXPECT_EQ(voxels, domain.voxels());
    EXPECT_EQ(leaves, tree.leaves.size());
    for (const int n : seen) EXPECT_EQ(n, 1);
  }
}

TEST(TileSums, PartsAddUpToTheWhole) {
  std::mt19937 random(4);
  std::vector<std::vector<float>> parts(20);
  for (auto& part : parts) {
    part.resize(random() % 600);
    for (float& v : part) v = 1e3F + static_cast<float>(random() % 1000) * 0.01F;
  }
  TileSumsBuilder builder;
  struct Part {
    double mean, residual, sse;
  };
  std::vector<Part> sums;
  long double total = 0;
  std::uint64_t count = 0;
  float low = 1e30F;
  float high = -1e30F;
  for (const auto& part : parts) {
    long double sum = 0;
    float part_low = 1e30F;
    float part_high = -1e30F;
    for (const float v : part) {
      sum += static_cast<long double>(v);
      part_low = std::min(part_low, v);
      part_high = std::max(part_high, v);
    }
    const auto mean = part.empty() ? 0.0F : static_cast<float>(sum / static_cast<long double>(part.size()));
    double residual = 0;
    double sse = 0;
    for (const float v : part) {
      residual += static_cast<double>(v) - static_cast<double>(mean);
      sse += std::pow(static_cast<double>(v) - static_cast<double>(mean), 2);
    }
    sums.push_back({static_cast<double>(mean), residual, sse});
    builder.add_mean(part.size(), static_cast<double>(mean), residual, part_low, part_high);
    total += sum;
    count += part.size();
    low = std::min(low, part_low);
    high = std::max(high, part_high);
  }
  builder.close_mean(-1);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    builder.add_squares(parts[i].size(), sums[i].mean, sums[i].residual, sums[i].sse);
  }
  EXPECT_EQ(builder.sums.finite, count);
  EXPECT_EQ(builder.sums.min, low);
  EXPECT_EQ(builder.sums.max, high);
  EXPECT_EQ(builder.sums.mean, static_cast<float>(total / static_cast<long double>(count)));
  for (const float fill : {builder.sums.mean, 0.0F, 1e6F, 1004.5F}) {
    long double squares = 0;
    long double worst = 0;
    for (const auto& part : parts) {
      for (const float v : part) {
        const long double d = std::abs(static_cast<long double>(v) - static_cast<long double>(fill));
        squares += d * d;
        worst = std::max(worst, d);
      }
    }
    EXPECT_NEAR(builder.sums.sse_about(fill), static_cast<double>(squares), static_cast<double>(squares) * 1e-13);
    EXPECT_EQ(builder.sums.max_abs_about(fill), static_cast<double>(worst));
  }
}

TEST(TileSums, OfNothingIsTheFallback) {
  TileSumsBuilder builder;
  builder.add_mean(0, 99, 99, 99, 99);
  builder.close_mean(0.5F);
  EXPECT_EQ(builder.sums.mean, 0.5F);
  EXPECT_EQ(builder.sums.max_abs_about(7), 0);
  EXPECT_EQ(builder.sums.sse_about(7), 0);
  EXPECT_EQ(tile_value({FillMode::mean, 3}, builder.sums), 3);
}

}  // namespace
}  // namespace weir::tree_regions_test
