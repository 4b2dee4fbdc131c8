#include "compressor/select/leaf_gain.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <tuple>
#include <vector>

#include "compressor/leaf/leaf_quantiser.h"
#include "compressor/leaf/leaf_summary.h"
#include "format/leaf/leaf_decode.h"
#include "tests/compressor/support/converted.h"
#include "tests/compressor/support/surveyed.h"

namespace weir::leaf_gain_test {
namespace {

using test::MemoryVolume;
using test::Surveyed;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

struct Case {
  Box domain;
  std::int64_t brick;  // voxels
};

float value_at(const Index3& i) {
  return std::sin(0.3F * static_cast<float>(i.x)) * static_cast<float>(i.y) - 0.05F * static_cast<float>(i.z * i.z);
}

// Visits the gains of all leaves in all regions, with the lattice position of each leaf.
template <typename Visit>
void for_each_gain(const Surveyed& surveyed, const GainRule& rule, Visit&& visit) {
  const TreeRegions tree(surveyed.volume.info().domain());
  for (std::int64_t region = 0; region < tree.region_lattice.size(); ++region) {
    const Box box = tree.leaf_box(region);
    std::vector<LeafRow> rows;
    surveyed.rows.read_box(box, rows);
    RegionGains gains;
    rule.gains(tree, RegionRows(rows.data(), box.extent(), box), gains);
    ASSERT_EQ(std::ssize(gains), box.voxels());
    for (std::size_t i = 0; i < gains.size(); ++i) {
      visit(tree, box.lo + index_at(static_cast<std::int64_t>(i), box.extent()), gains[i]);
    }
  }
}

class PaperMetricTest : public testing::TestWithParam<Case> {};

TEST_P(PaperMetricTest, IsTheDistanceOfTheBricksRangeFromTheBackground) {
  MemoryVolume volume(GetParam().domain, value_at);
  const Surveyed surveyed(volume);
  const float background = -1.5F;
  for (const Metric metric : {Metric::closest, Metric::farthest, Metric::median}) {
    const GainRule rule{metric, GetParam().brick / 8, {FillMode::background, background, NonFinitePolicy::error}};
    for_each_gain(surveyed, rule, [&](const TreeRegions& tree, const Index3& leaf, const LeafGain& gain) {
      const Index3 lo = floor_div(tree.leaves.node_box(leaf).lo, GetParam().brick) * GetParam().brick;
      const Box brick{lo, lo + Index3{GetParam().brick, GetParam().brick, GetParam().brick}};
      const std::vector<float> values = volume.in(brick);
      const auto low = static_cast<double>(*std::min_element(values.begin(), values.end()));
      const auto high = static_cast<double>(*std::max_element(values.begin(), values.end()));
      const double to_low = std::abs(low - static_cast<double>(background));
      const double to_high = std::abs(high - static_cast<double>(background));
      const double expected = metric == Metric::closest ? std::min(to_low, to_high)
                              : metric == Metric::farthest
                                  ? std::max(to_low, to_high)
                                  : std::abs((low + high) / 2 - static_cast<double>(background));
      ASSERT_EQ(gain.first_gain(), expected) << leaf.x << ' ' << leaf.y << ' ' << leaf.z;
    });
  }
}

INSTANTIATE_TEST_SUITE_P(Bricks, PaperMetricTest,
                         testing::Values(Case{{{0, 0, 0}, {70, 45, 33}}, 8}, Case{{{0, 0, 0}, {70, 45, 33}}, 16},
                                         Case{{{0, 0, 0}, {140, 45, 33}}, 32}, Case{{{-77, -3, 5}, {66, 40, 41}}, 8},
                                         Case{{{-77, -3, 5}, {66, 40, 41}}, 16},
                                         Case{{{-77, -3, 5}, {66, 40, 41}}, 32}),
                         [](const auto& parameter) { return "Case" + std::to_string(parameter.index); });

TEST(LeafGain, SseIsTheSquaredErrorThatTheTileCosts) {
  MemoryVolume volume({{-20, 3, 0}, {130, 20, 17}}, value_at);
  const Surveyed surveyed(volume);
  for (const FillMode mode : {FillMode::mean, FillMode::background}) {
    const GainRule rule{Metric::sse, 1, {mode, 0.75F, NonFinitePolicy::error}};
    for_each_gain(surveyed, rule, [&](const TreeRegions& tree, const Index3& leaf, const LeafGain& gain) {
      const Box box = tree.leaves.voxels(leaf);
      const auto tile = static_cast<long double>(test::expected_tile(volume, box, mode, 0.75F));
      long double expected = 0;
      for (const float v : volume.in(box)) {
        expected += (static_cast<long double>(v) - tile) * (static_cast<long double>(v) - tile);
      }
      EXPECT_NEAR(gain.first_gain(), static_cast<double>(expected), static_cast<double>(expected) * 1e-13);
      EXPECT_FALSE(gain.exact);
    });
  }
}

TEST(LeafGain, CornersAndKeptNonFiniteValuesAreRequired) {
  MemoryVolume volume({{0, 0, 0}, {32, 16, 8}}, [](const Index3& i) {
    return i == Index3{9, 1, 1} ? kNaN : static_cast<float>(i.x);
  });
  const Surveyed surveyed(volume);
  for (const NonFinitePolicy policy : {NonFinitePolicy::background, NonFinitePolicy::keep}) {
    std::vector<std::int64_t> required;
    for_each_gain(surveyed, {Metric::sse, 1, {FillMode::mean, 0, policy}},
                  [&](const TreeRegions& tree, const Index3& leaf, const LeafGain& gain) {
                    if (gain.required) required.push_back(tree.leaves.linear(leaf));
                  });
    EXPECT_EQ(required, policy == NonFinitePolicy::keep ? (std::vector<std::int64_t>{0, 1, 7})
                                                        : (std::vector<std::int64_t>{0, 7}));
  }
}

TEST(LeafGain, ExactTilesHaveZeroGainInEveryMetric) {
  // The second brick of 16 voxels holds one leaf that its tile reproduces, and three that its tile does not.
  MemoryVolume volume({{0, 0, 0}, {32, 16, 8}}, [](const Index3& i) {
    return i.x >= 16 && i.x < 24 && i.y < 8 ? 3.0F : static_cast<float>(i.x * i.y);
  });
  const Surveyed surveyed(volume);
  for (const Metric metric : {Metric::sse, Metric::closest, Metric::farthest, Metric::median}) {
    for_each_gain(surveyed, {metric, 2, {FillMode::mean, -5.0F, NonFinitePolicy::error}},
                  [&](const TreeRegions&, const Index3& leaf, const LeafGain& gain) {
                    const bool exact = leaf == Index3{2, 0, 0};
                    EXPECT_EQ(gain.exact, exact);
                    EXPECT_EQ(gain.first_gain() == 0, exact);
                  });
  }
}

TEST(LeafGain, PositionsAndBricksFollowTheLowerNode) {
  MemoryVolume volume({{-16, 120, 8}, {8, 136, 24}}, value_at);
  const Surveyed surveyed(volume);
  for_each_gain(surveyed, {Metric::farthest, 4, {}},
                [](const TreeRegions& tree, const Index3& leaf, const LeafGain& gain) {
                  const Index3 node = tree.leaves.first + leaf;
                  const std::int64_t x = (node.x % 16 + 16) % 16;
                  const std::int64_t y = node.y % 16;
                  const std::int64_t z = node.z % 16;
                  EXPECT_EQ(gain.position, x * 256 + y * 16 + z);
                  EXPECT_EQ(gain.brick, x / 4 + 4 * (y / 4) + 16 * (z / 4));
                });
}

// Returns the steps of a region's leaves with keys of at least `least`, as (leaf, level, key).
std::vector<std::tuple<std::uint16_t, KeptLevel, double>> steps_from(const RegionGains& gains, double least) {
  std::vector<std::tuple<std::uint16_t, KeptLevel, double>> steps;
  for (const LeafGain& leaf : gains) {
    for (const LeafStep& step : leaf.all_steps()) {
      if (step.key >= least || leaf.required) steps.emplace_back(leaf.position, step.level, step.key);
    }
  }
  return steps;
}

TEST(LeafGain, StepsFromALeastKeyOn_AreThoseOfAllKeys) {
  MemoryVolume volume({{0, 0, 0}, {120, 60, 70}}, value_at);
  const Surveyed surveyed(volume);
  const TreeRegions tree(volume.info().domain());
  const Box box = tree.leaf_box(0);
  std::vector<LeafRow> rows;
  surveyed.rows.read_box(box, rows);
  const RegionRows region(rows.data(), box.extent(), box);
  for (const Encoding encoding : {Encoding::float32, Encoding::fpn, Encoding::fp8}) {
    GainRule rule;
    rule.encoding = encoding;
    RegionGains all;
    rule.gains(tree, region, all);
    std::vector<double> keys;
    for (const LeafGain& leaf : all) {
      for (const LeafStep& step : leaf.all_steps()) keys.push_back(step.key);
    }
    std::sort(keys.begin(), keys.end());
    std::size_t most = 0;
    for (const double share : {0.0, 0.2, 0.5, 0.8, 0.99}) {
      const double least = keys[static_cast<std::size_t>(share * static_cast<double>(keys.size()))];
      RegionGains gains;
      rule.gains(tree, region, gains, least);
      EXPECT_EQ(gains.size(), all.size());
      EXPECT_EQ(steps_from(gains, least), steps_from(all, least)) << share;
      const std::size_t left_out = steps_from(all, 0).size() - steps_from(gains, 0).size();
      EXPECT_GE(left_out, most);
      most = left_out;
    }
    EXPECT_GT(most, 0U) << "nothing was left out";
  }
}

TEST(LeafGain, SseGivesEachLeafItsOwnBrick) {
  MemoryVolume volume({{0, 0, 0}, {64, 64, 16}}, value_at);
  const Surveyed surveyed(volume);
  std::vector<std::uint32_t> bricks;
  for_each_gain(surveyed, {Metric::sse, 4, {}},
                [&](const TreeRegions&, const Index3&, const LeafGain& gain) { bricks.push_back(gain.brick); });
  std::sort(bricks.begin(), bricks.end());
  EXPECT_EQ(std::adjacent_find(bricks.begin(), bricks.end()), bricks.end());
}

LeafRow summarized(const std::vector<float>& values) {
  LeafRow row = summarize_leaf(values, 0);
  summarize_widths(values, true, row);
  return row;
}

double fitted_error(const std::vector<float>& values, const LeafRow& row, LeafWidth width) {
  const unsigned bits = 1U << bits_log2_of(width);
  const Quantiser fit = fit_quantiser(values, {row.min, row.max, row.mean}, bits);
  std::vector<std::uint16_t> codes(values.size());
  quantise(values, fit, codes);
  double error = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    error += std::pow(
        static_cast<double>(values[i]) - static_cast<double>(dequantize(codes[i], fit.quantum, fit.minimum)), 2);
  }
  return error;
}

TEST(LeafGain, QuantisedErrorOfWideCodesIsNearTheFit) {
  std::mt19937 random(3);
  std::vector<float> values(512);
  // From leaves with nearly all values between the ends to leaves at a border, with nearly all values at one end.
  for (const std::size_t anywhere : {511U, 300U, 100U, 20U}) {
    for (const float end : {0.0F, 1.0F}) {
      std::fill(values.begin(), values.end(), end);
      values[0] = 1 - end;
      for (std::size_t i = 1; i < anywhere; ++i) values[i] = static_cast<float>(random() >> 8U) * 0x1p-24F;
      const LeafRow row = summarized(values);
      EXPECT_EQ(row.exact_bits, 0U);
      EXPECT_EQ(row.at_ends, 513 - anywhere);
      for (const LeafWidth width : {LeafWidth::bits8, LeafWidth::bits16}) {
        const double error = fitted_error(values, row, width);
        EXPECT_NEAR(quantised_error(row, 512, 0, width), error, error * 0.35) << anywhere;
      }
    }
  }
}

// Returns the row of a leaf with 500 finite values and 12 values that are NaN.
LeafRow with_gaps(const std::vector<float>& values) {
  std::vector<float> with_nan = values;
  with_nan.resize(512, kNaN);
  LeafRow row = summarize_leaf(with_nan, 0);
  summarize_widths(values, false, row);
  return row;
}

TEST(LeafGain, WhatReplacesNaNWidensTheRangeOfALeaf) {
  std::vector<float> values(500);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i % 16);
  const LeafRow row = with_gaps(values);
  // Sixteen values are exact at 4 bits, but not together with 1000.1, which does not lie on their lattice.
  EXPECT_EQ(quantised_error(row, 500, 1000.1F, LeafWidth::bits4), 0);
  const double quantum = static_cast<double>(1000.1F / 65535.0F);
  EXPECT_EQ(quantised_error(row, 512, 1000.1F, LeafWidth::bits16), 500 * quantum * quantum / 12);
  EXPECT_EQ(quantised_error(row, 512, 1000.1F, LeafWidth::bits1), row.sse);
}

TEST(LeafGain, WhatReplacesNaNMayLieOnTheLatticeOfTheOthers) {
  std::vector<float> values(500);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = 3 * static_cast<float>(i % 16);
  const LeafRow row = with_gaps(values);
  struct Expected {
    float background;
    unsigned bits;
  };
  // Sixteen multiples of 3, up to 45, then 17, 256 and 257 multiples, then whole numbers, then half numbers.
  for (const Expected& of : {Expected{0, 4}, {45, 4}, {48, 8}, {765, 8}, {768, 16}, {-3, 8}, {46, 8}, {0.5F, 8}}) {
    for (unsigned log2 = 0; log2 < 5; ++log2) {
      const LeafWidth width = width_of(log2);
      const bool exact = 1U << log2 >= of.bits;
      EXPECT_EQ(keeps_every_bit(row, 512, of.background, width), exact) << of.background << ", " << (1U << log2);
      EXPECT_EQ(quantised_error(row, 512, of.background, width) == 0, exact) << of.background << ", " << (1U << log2);
    }
  }
  EXPECT_FALSE(keeps_every_bit(row, 512, -0.0F, LeafWidth::bits16));
  EXPECT_FALSE(keeps_every_bit(row, 512, 0.1F, LeafWidth::bits16));
  EXPECT_FALSE(keeps_every_bit(row, 512, 3.0F * 65536.0F, LeafWidth::bits16));
  const LeafRow one = with_gaps(std::vector<float>(500, 7));
  EXPECT_TRUE(keeps_every_bit(one, 512, 7, LeafWidth::bits1));
  EXPECT_TRUE(keeps_every_bit(one, 512, 0, LeafWidth::bits1));
  EXPECT_FALSE(keeps_every_bit(one, 512, 0.1F, LeafWidth::bits16));
}

// Returns the row of a leaf with values of -most, except that every third value is at least `most` / 512.
LeafRow nearly_all_at_one_end(float most) {
  std::vector<float> values(512, -most);
  for (std::size_t i = 0; i < 512; i += 3) values[i] = most / static_cast<float>(1 + i);
  return summarized(values);
}

TEST(LeafGain, WidthsThatFloatCannotHold_GainNothing) {
  const LeafRow row = nearly_all_at_one_end(0x1p-130F);
  for (unsigned log2 = 0; log2 < 5; ++log2) EXPECT_EQ(quantised_error(row, 512, 0, width_of(log2)), row.sse);
  EXPECT_EQ(quantised_error(row, 512, 0, LeafWidth::float32), 0);
}

TEST(LeafGain, RangesBeyondFloat_GainByAFewBitsAndNothingByMore) {
  const LeafRow row = nearly_all_at_one_end(3e38F);
  double least = row.sse;
  for (unsigned log2 = 0; log2 < 5; ++log2) {
    const double error = quantised_error(row, 512, 0, width_of(log2));
    EXPECT_LE(error, least);
    if (log2 > 2) {
      EXPECT_EQ(error, least);
    }
    least = std::min(least, error);
  }
  EXPECT_LT(least, 0.7 * row.sse);
  EXPECT_EQ(quantised_error(row, 512, 0, LeafWidth::float32), 0);
}

}  // namespace
}  // namespace weir::leaf_gain_test
