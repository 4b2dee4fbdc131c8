// Results for values that are known to repeat each other are the same, bit for bit, as without that knowledge.
#include "compressor/leaf/leaf_repeats.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <random>
#include <vector>

#include "compressor/leaf/leaf_quantiser.h"
#include "compressor/leaf/leaf_summary.h"
#include "compressor/leaf/quantised_leaf.h"
#include "ingest/plan/block_parts.h"

namespace weir::leaf_repeats_test {
namespace {

using Draw = std::function<float(std::mt19937&)>;

const std::vector<Draw> kDraws{
    [](std::mt19937& random) { return std::uniform_real_distribution<float>(-3, 5)(random); },
    [](std::mt19937& random) {
      return std::ldexp(static_cast<float>(random() % 1000), static_cast<int>(random() % 80));
    },
    [](std::mt19937& random) { return static_cast<float>(random() % 5) * 0.25F; },
    [](std::mt19937& random) { return random() % 2 == 0 ? -0.0F : 0.0F; },
    [](std::mt19937& random) { return random() % 3 == 0 ? -0.0F : static_cast<float>(random() % 2); },
    [](std::mt19937&) { return 0.3F; },
    [](std::mt19937& random) {
      return random() % 4 == 0 ? 1e-30F : std::normal_distribution<float>(0, 1e-3F)(random);
    }};

struct RepeatedValues {
  Index3 by;
  std::vector<float> distinct;
  std::array<float, kLeafVoxels> values;
};

void for_each_case(const std::function<void(const RepeatedValues&)>& visit) {
  std::mt19937 random(7);
  for (const std::int64_t x : {1, 2, 4, 8}) {
    for (const std::int64_t y : {1, 2, 4, 8}) {
      for (const std::int64_t z : {1, 2, 4, 8}) {
        for (const Draw& draw : kDraws) {
          RepeatedValues repeated{{x, y, z}, {}, {}};
          for (std::int64_t i = 0; i < kLeafVoxels / (x * y * z); ++i) repeated.distinct.push_back(draw(random));
          repeat_values(repeated.distinct.data(), repeated.by, {8, 8, 8}, repeated.values.data());
          visit(repeated);
        }
      }
    }
  }
}

TEST(LeafRepeats, RepeatedValues_AreEachThoseOfTheirGroup) {
  for_each_case([](const RepeatedValues& repeated) {
    const Index3 by = repeated.by;
    for (std::int64_t i = 0; i < kLeafVoxels; ++i) {
      const Index3 at = index_at(i, {8, 8, 8});
      const Index3 group{at.x / by.x, at.y / by.y, at.z / by.z};
      const float expected =
          repeated.distinct[static_cast<std::size_t>(linear_index(group, Index3{8 / by.x, 8 / by.y, 8 / by.z}))];
      ASSERT_EQ(repeated.values[static_cast<std::size_t>(i)], expected);
    }
  });
}

TEST(LeafRepeats, Rows_AreThoseOfAllValues) {
  for_each_case([](const RepeatedValues& repeated) {
    SCOPED_TRACE(testing::Message() << repeated.by.x << ' ' << repeated.by.y << ' ' << repeated.by.z);
    const LeafRepeats repeats = LeafRepeats::in_source_order(repeated.by);
    LeafRow expected = summarize_leaf(repeated.values, 17);
    UniformDigest none;
    LeafRow row = summarize_leaf(repeated.values, 17, none, repeated.distinct, repeats);
    ASSERT_EQ(std::memcmp(&row, &expected, sizeof row), 0);
    summarize_widths(repeated.values, true, expected);
    summarize_widths(repeated.values, repeated.distinct, repeats, row);
    ASSERT_EQ(std::memcmp(&row, &expected, sizeof row), 0);
  });
}

TEST(LeafRepeats, Quantisers_AreThoseOfAllValues) {
  for_each_case([](const RepeatedValues& repeated) {
    SCOPED_TRACE(testing::Message() << repeated.by.x << ' ' << repeated.by.y << ' ' << repeated.by.z);
    const LeafRepeats repeats = LeafRepeats::in_source_order(repeated.by);
    const ValueRange expected_range = leaf_range(repeated.values);
    const ValueRange range = leaf_range(repeated.values, repeats);
    ASSERT_EQ(std::memcmp(&range, &expected_range, 3 * sizeof(float)), 0);
    ASSERT_EQ(range.deviation, expected_range.deviation);
    if (!(range.min < range.max)) return;
    for (const unsigned bits : {1U, 2U, 4U, 8U, 16U}) {
      const Quantiser expected = fit_quantiser(repeated.values, range, bits);
      const Quantiser found = fit_quantiser(repeated.values, range, bits, repeats);
      ASSERT_EQ(std::memcmp(&found, &expected, sizeof found), 0) << bits << " bits";
    }
  });
}

TEST(LeafRepeats, QuantisedLeaves_AreThoseOfAllValues) {
  const Box node{{8, 0, 16}, {16, 8, 24}};
  for_each_case([&](const RepeatedValues& repeated) {
    SCOPED_TRACE(testing::Message() << repeated.by.x << ' ' << repeated.by.y << ' ' << repeated.by.z);
    const LeafRepeats repeats = LeafRepeats::in_leaf_order({repeated.by.z, repeated.by.y, repeated.by.x});
    LeafValues values;
    std::copy(repeated.values.begin(), repeated.values.end(), values.begin());
    for (const Fit fit : {Fit::squares, Fit::largest}) {
      for (unsigned log2 = 0; log2 <= 4; ++log2) {
        const QuantisedLeaf expected = quantise_leaf(values, values, node, node, log2, fit);
        const QuantisedLeaf found = quantise_leaf(values, values, node, node, log2, fit, repeats);
        ASSERT_EQ(std::memcmp(&found.quantiser, &expected.quantiser, sizeof found.quantiser), 0);
        ASSERT_EQ(found.codes, expected.codes);
        ASSERT_EQ(std::memcmp(found.decoded.data(), expected.decoded.data(), sizeof found.decoded), 0);
        ASSERT_EQ(found.squared_error, expected.squared_error);
        ASSERT_EQ(found.max_abs, expected.max_abs);
        ASSERT_EQ(found.kept, expected.kept);
        ASSERT_EQ(found.zeros_lost, expected.zeros_lost);
      }
    }
  });
}

}  // namespace
}  // namespace weir::leaf_repeats_test
