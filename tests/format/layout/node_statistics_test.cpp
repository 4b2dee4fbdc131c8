#include "format/layout/node_statistics.h"

#include <gtest/gtest.h>
#include <nanovdb/util/GridStats.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace weir::node_statistics_test {
namespace {

using StockStats = nanovdb::Stats<float>;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();

std::uint64_t bits_of(double v) { return std::bit_cast<std::uint64_t>(v); }

void expect_same(const NodeStatistics& ours, const StockStats& stock) {
  EXPECT_EQ(ours.count, stock.size());
  EXPECT_EQ(ours.min, stock.min());
  EXPECT_EQ(ours.max, stock.max());
  if (std::isnan(stock.avg())) {
    EXPECT_TRUE(std::isnan(ours.average()));
    EXPECT_EQ(std::isnan(ours.deviation()), std::isnan(stock.std()));
    return;
  }
  EXPECT_EQ(bits_of(ours.mean), bits_of(stock.avg()));
  EXPECT_EQ(ours.average(), static_cast<float>(stock.avg()));
  EXPECT_EQ(ours.deviation(), static_cast<float>(stock.std()));
}

std::vector<std::vector<float>> sequences() {
  std::mt19937 random(6);
  std::vector<std::vector<float>> all{{}, {5}, {-0.0F, 0.0F}, {3e38F, -3e38F, 3e38F}, {kNaN}, {1, kNaN, 2}, {kInf, 1}};
  for (int n = 0; n < 40; ++n) {
    std::vector<float> values(random() % 600);
    for (float& v : values) {
      v = std::ldexp(static_cast<float>(random() >> 8U) - 0x1p23F, static_cast<int>(random() % 40) - 40);
    }
    all.push_back(std::move(values));
  }
  return all;
}

NodeStatistics ours_of(const std::vector<float>& values) {
  NodeStatistics ours;
  for (const float v : values) ours.add(v);
  return ours;
}

StockStats stock_of(const std::vector<float>& values) {
  StockStats stock;
  for (const float v : values) stock.add(v);
  return stock;
}

TEST(NodeStatistics, AddsSingleValuesAsStockDoes) {
  for (const auto& values : sequences()) expect_same(ours_of(values), stock_of(values));
}

TEST(NodeStatistics, AddsTilesAndChildrenAsStockDoes) {
  NodeStatistics ours;
  StockStats stock;
  float tile = 0.1F;
  for (const auto& values : sequences()) {
    if (std::any_of(values.begin(), values.end(), [](float v) { return !std::isfinite(v); })) continue;
    for (const std::uint64_t voxels : {std::uint64_t{512}, std::uint64_t{1} << 21U, std::uint64_t{1} << 36U}) {
      tile = tile * -1.7F + 0.3F;
      if (std::abs(tile) > 1e6F) tile = 0.1F;
      ours.add_tile(tile, voxels, {{0, 0, 0}, {1, 1, 1}});
      stock.add(tile, voxels);
      expect_same(ours, stock);
    }
    ours.add(ours_of(values));
    stock.add(stock_of(values));
    expect_same(ours, stock);
  }
}

TEST(NodeStatistics, EmptyChildrenChangeNothing) {
  NodeStatistics ours = ours_of({1, 2, 4});
  const double mean = ours.mean;
  ours.add(NodeStatistics{});
  EXPECT_EQ(ours.mean, mean);
  EXPECT_EQ(ours.count, 3U);
  NodeStatistics empty;
  empty.add(NodeStatistics{});
  EXPECT_EQ(empty.count, 0U);
  EXPECT_EQ(empty.deviation(), 0);
}

TEST(NodeStatistics, BoxIsTheUnionAndInvertedAtFirst) {
  NodeStatistics statistics;
  EXPECT_TRUE(statistics.bbox.empty());
  statistics.add_box({{1, 2, 3}, {4, 5, 6}});
  EXPECT_EQ(statistics.bbox, (Box{{1, 2, 3}, {4, 5, 6}}));
  statistics.add_box({{-7, 4, 4}, {2, 9, 5}});
  EXPECT_EQ(statistics.bbox, (Box{{-7, 2, 3}, {4, 9, 6}}));
}

}  // namespace
}  // namespace weir::node_statistics_test
