// Leaves that are surveyed eight at once get the same rows, bit for bit, as each leaf alone.
#include "compressor/leaf/lanes/leaf_lanes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <random>
#include <vector>

#include "compressor/leaf/leaf_summary.h"
#include "ingest/plan/block_parts.h"

namespace weir::leaf_lanes_test {
namespace {

using Draw = std::function<float(std::mt19937&)>;

// The distributions that the values of a leaf are drawn from.
const std::vector<Draw> kDraws{
    [](std::mt19937& random) { return std::uniform_real_distribution<float>(-3, 5)(random); },
    [](std::mt19937& random) { return 1 + std::uniform_real_distribution<float>(0, 1e-3F)(random); },
    [](std::mt19937& random) {
      return std::ldexp(static_cast<float>(random() % 1000), static_cast<int>(random() % 80));
    },
    [](std::mt19937& random) { return std::ldexp(1.0F, -static_cast<int>(random() % 140)); },
    [](std::mt19937& random) { return random() % 2 == 0 ? -3e38F : 3e38F; },
    [](std::mt19937& random) { return static_cast<float>(random() % 5) * 0.25F; },
    [](std::mt19937& random) { return static_cast<float>(random() % 3000); },
    [](std::mt19937& random) { return static_cast<float>(random() % 4) + (random() % 9 == 0 ? 1e-4F : 0.0F); },
    [](std::mt19937& random) { return random() % 2 == 0 ? -0.0F : 0.0F; },
    [](std::mt19937& random) { return random() % 3 == 0 ? -0.0F : static_cast<float>(random() % 2); },
    [](std::mt19937& random) { return random() % 5 == 0 ? std::exponential_distribution<float>(1)(random) : 0.0F; },
    [](std::mt19937& random) { return -std::abs(std::normal_distribution<float>(100, 1)(random)); },
    [](std::mt19937& random) {
      return random() % 4 == 0 ? 1e-30F : std::normal_distribution<float>(0, 1e-3F)(random);
    }};

// Returns the row of a leaf alone, computed from all of its voxels.
LeafRow row_of(const std::vector<float>& distinct, const Index3& by, bool widths) {
  std::array<float, kLeafVoxels> values;
  repeat_values(distinct.data(), by, {kLeafDim, kLeafDim, kLeafDim}, values.data());
  LeafRow row = summarize_leaf(values, 0);
  if (widths) summarize_widths(values, true, row);
  row.sample = 0;
  row.digest = {};
  return row;
}

void expect_rows(LeafLanes& lanes, const std::vector<std::vector<float>>& leaves, const Index3& by, bool widths) {
  lanes.begin(by);
  for (const std::vector<float>& leaf : leaves) lanes.add(leaf);
  std::array<LeafRow, kLeafLanes> rows;
  lanes.summarize(widths, rows);
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    const LeafRow expected = row_of(leaves[i], by, widths);
    ASSERT_EQ(rows[i].min, expected.min);
    ASSERT_EQ(rows[i].max, expected.max);
    ASSERT_EQ(rows[i].mean, expected.mean);
    ASSERT_EQ(rows[i].residual, expected.residual);
    ASSERT_EQ(rows[i].sse, expected.sse);
    ASSERT_EQ(rows[i].quantised, expected.quantised);
    ASSERT_EQ(rows[i].exact_bits, expected.exact_bits);
    ASSERT_EQ(rows[i].at_ends, expected.at_ends);
    ASSERT_EQ(std::memcmp(&rows[i], &expected, sizeof expected), 0) << "zeros, or the sign of one";
  }
}

TEST(LeafLanes, Rows_AreThoseOfEachLeafAlone) {
  std::mt19937 random(11);
  LeafLanes lanes;
  for (const std::int64_t x : {2, 4, 8}) {
    for (const std::int64_t y : {2, 4, 8}) {
      for (const std::int64_t z : {1, 2, 4, 8}) {
        const Index3 by{x, y, z};
        ASSERT_TRUE(LaneShape::suits(by));
        const std::int64_t count = kLeafVoxels / (x * y * z);
        if (count == 1) continue;  // leaves of one value do not go through lanes
        SCOPED_TRACE(testing::Message() << x << ' ' << y << ' ' << z);
        for (int round = 0; round < 40; ++round) {
          std::vector<std::vector<float>> leaves;
          for (std::size_t i = 0; i < 1 + random() % kLeafLanes; ++i) {
            const Draw& draw = kDraws[random() % kDraws.size()];
            std::vector<float> distinct(static_cast<std::size_t>(count));
            for (float& v : distinct) v = draw(random);
            if (LeafLanes::takes(distinct)) leaves.push_back(distinct);
          }
          ASSERT_NO_FATAL_FAILURE(expect_rows(lanes, leaves, by, round % 4 != 0));
        }
      }
    }
  }
}

TEST(LeafLanes, ManyLeaves_OfCellsInEighths_HaveTheRowsOfEachAlone) {
  std::mt19937 random(5);
  LeafLanes lanes;
  for (int round = 0; round < 3000; ++round) {
    std::vector<std::vector<float>> leaves(kLeafLanes);
    for (std::vector<float>& distinct : leaves) {
      const float centre = std::normal_distribution<float>(0, 1)(random);
      const float spread = std::exp(std::normal_distribution<float>(-4, 2)(random));
      for (int i = 0; i < 8; ++i) distinct.push_back(centre + spread * std::normal_distribution<float>(0, 1)(random));
      if (round % 3 == 0) distinct[random() % 8] = 0;
      if (round % 5 == 0) {
        for (float& v : distinct) v = std::max(v, 0.0F);
        distinct[0] = spread;
        distinct[7] = 0;
      }
    }
    ASSERT_NO_FATAL_FAILURE(expect_rows(lanes, leaves, {4, 4, 4}, true)) << round;
  }
}

TEST(LeafLanes, ValuesThatAreEqualOrNotFinite_AreNotTaken) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  EXPECT_TRUE(LeafLanes::takes(std::vector<float>{1, 1, 2, 1}));
  EXPECT_TRUE(LeafLanes::takes(std::vector<float>{0.0F, -0.0F}));
  EXPECT_FALSE(LeafLanes::takes(std::vector<float>{1, 1, 1, 1}));
  EXPECT_FALSE(LeafLanes::takes(std::vector<float>{1, 2, kInfinity, 1}));
  EXPECT_FALSE(LeafLanes::takes(std::vector<float>{1, 2, std::nanf(""), 1}));
}

TEST(LeafLanes, RowsOfSingleVoxels_DoNotSuit) {
  EXPECT_FALSE(LaneShape::suits({1, 4, 4}));
  EXPECT_FALSE(LaneShape::suits({4, 1, 4}));
  EXPECT_TRUE(LaneShape::suits({4, 4, 1}));
}

}  // namespace
}  // namespace weir::leaf_lanes_test
