#include "compressor/leaf/leaf_summary.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <ostream>
#include <random>
#include <set>
#include <string>
#include <vector>

namespace weir::leaf_summary_test {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();

std::uint32_t bits_of(float v) { return std::bit_cast<std::uint32_t>(v); }

struct Values {
  std::string name;
  std::vector<float> values;
  bool exact = false;  // all sums are exact in double, so the test compares without tolerance
};

std::ostream& operator<<(std::ostream& out, const Values& v) { return out << v.name; }

std::vector<float> draw(std::size_t count, const std::function<float(std::mt19937&)>& value) {
  std::mt19937 random(5);
  std::vector<float> values(count);
  for (float& v : values) v = value(random);
  return values;
}

float uniform(std::mt19937& random) { return static_cast<float>(random() >> 8U) * 0x1p-24F; }

std::vector<Values> value_sets() {
  std::vector<Values> sets{
      {"Integers", draw(512, [](auto& r) { return static_cast<float>(r() % 256); }), true},
      {"Checkerboard", draw(512, [i = 0](auto&) mutable { return static_cast<float>(i++ % 2); }), true},
      {"Unit", draw(512, uniform)},
      {"Huge", draw(512, [](auto& r) { return (uniform(r) - 0.5F) * 2 * 3e38F; })},
      {"Tiny", draw(512, [](auto& r) { return (uniform(r) - 0.5F) * 1e-16F; })},
      {"Denormals", draw(512, [](auto& r) { return static_cast<float>(r() % 4096) * 0x1p-149F; }), true},
      {"Offset", draw(512, [](auto& r) { return 1e8F + 8.0F * static_cast<float>(r() % 64); }), true},
      {"SpikeOnPlateau", draw(512, [i = 0](auto&) mutable { return i++ == 300 ? 1e6F : 1.0F; }), true},
      {"SomeNonFinite",
       draw(512,
            [](auto& r) {
              const auto die = r() % 10;
              return die == 0 ? kNaN : die == 1 ? kInf : die == 2 ? -kInf : static_cast<float>(die);
            }),
       true},
      {"OneFinite", draw(512, [i = 0](auto&) mutable { return i++ == 77 ? -3.5F : kNaN; }), true},
      {"TwoFinite", draw(512, [i = 0](auto&) mutable { return i++ % 256 == 77 ? static_cast<float>(i) : kInf; }), true},
      {"ZerosOfBothSigns", draw(512, [](auto& r) { return r() % 2 == 0 ? 0.0F : -0.0F; }), true},
      {"ZeroPlusMinus", {0.0F, -1.0F, 1.0F, -0.0F}, true},
  };
  // Every length tests the lanes and their remainders.
  for (std::size_t count = 1; count <= 50; ++count) {
    sets.push_back(
        {"Length" + std::to_string(count), draw(count, [](auto& r) { return static_cast<float>(r() % 1024); }), true});
  }
  for (const std::size_t count : {72U, 343U, 448U, 511U}) {
    sets.push_back({"Length" + std::to_string(count), draw(count, uniform)});
  }
  return sets;
}

class LeafSummaryTest : public testing::TestWithParam<Values> {};

TEST_P(LeafSummaryTest, HasTheSumsOfTheFiniteValues) {
  const auto& values = GetParam().values;
  const LeafRow row = summarize_leaf(values, 0);
  std::vector<float> finite;
  std::copy_if(values.begin(), values.end(), std::back_inserter(finite), [](float v) { return std::isfinite(v); });
  ASSERT_EQ(row.finite, finite.size());
  EXPECT_EQ(row.min, *std::min_element(finite.begin(), finite.end()));
  EXPECT_EQ(row.max, *std::max_element(finite.begin(), finite.end()));
  const std::set<std::uint32_t> patterns = [&] {
    std::set<std::uint32_t> all;
    for (const float v : finite) all.insert(bits_of(v));
    return all;
  }();
  EXPECT_EQ(row.uniform(), patterns.size() == 1);
  long double total = 0;
  for (const float v : finite) total += static_cast<long double>(v);
  EXPECT_EQ(row.mean, static_cast<float>(total / static_cast<long double>(finite.size())));
  long double residual = 0;
  long double squares = 0;
  for (const float v : finite) {
    const long double d = static_cast<long double>(v) - static_cast<long double>(row.mean);
    residual += d;
    squares += d * d;
  }
  if (GetParam().exact && row.mean == std::floor(row.mean)) {
    EXPECT_EQ(row.sse, static_cast<double>(squares));
    EXPECT_EQ(row.residual, static_cast<float>(residual));
  } else {
    EXPECT_NEAR(row.sse, static_cast<double>(squares), static_cast<double>(squares) * 1e-15);
    // The residual of a rounded mean is far below the spread of the values, so the tolerance is absolute.
    const double scale = std::sqrt(static_cast<double>(squares) / static_cast<double>(finite.size()));
    EXPECT_NEAR(static_cast<double>(row.residual), static_cast<double>(residual),
                std::abs(static_cast<double>(residual)) * 6e-8 + scale * 1e-12);
  }
  EXPECT_EQ(row.digest, leaf_digest(values));
}

TEST_P(LeafSummaryTest, GivesErrorsAboutAnyFillFromTheSums) {
  const auto& values = GetParam().values;
  const LeafRow row = summarize_leaf(values, 0);
  for (const float fill : {0.0F, row.mean, row.min, row.max, 1e8F, -1e-3F, std::nextafter(row.mean, kInf)}) {
    long double squares = 0;
    long double worst = 0;
    for (const float v : values) {
      if (!std::isfinite(v)) continue;
      const long double d = std::abs(static_cast<long double>(v) - static_cast<long double>(fill));
      squares += d * d;
      worst = std::max(worst, d);
    }
    EXPECT_NEAR(row.sse_about(fill), static_cast<double>(squares), static_cast<double>(squares) * 1e-13) << fill;
    EXPECT_EQ(row.max_abs_about(fill), static_cast<double>(worst)) << fill;
  }
}

INSTANTIATE_TEST_SUITE_P(Values, LeafSummaryTest, testing::ValuesIn(value_sets()),
                         [](const auto& parameter) { return parameter.param.name; });

TEST(LeafSummary, NoFiniteValues_GiveAZeroSummary) {
  for (const float v : {kNaN, kInf, -kInf}) {
    const LeafRow row = summarize_leaf(std::vector<float>(512, v), 17);
    EXPECT_EQ(row.finite, 0U);
    EXPECT_FALSE(row.uniform());
    EXPECT_EQ(row.min, 0);
    EXPECT_EQ(row.max, 0);
    EXPECT_EQ(row.mean, 0);
    EXPECT_EQ(row.sse, 0);
    EXPECT_EQ(row.residual, 0);
    EXPECT_TRUE(std::isnan(row.sample));
    EXPECT_EQ(row.sse_about(5), 0);
    EXPECT_EQ(row.max_abs_about(5), 0);
  }
}

TEST(LeafSummary, OneValueKeepsItsBits) {
  for (const float v : {0.0F, -0.0F, 0.1F, 1e8F, 3e38F, -3e38F, 0x1p-149F, -0x1p-149F}) {
    for (const std::size_t count : {1U, 7U, 16U, 17U, 511U, 512U}) {
      const LeafRow row = summarize_leaf(std::vector<float>(count, v), count - 1);
      EXPECT_TRUE(row.uniform());
      EXPECT_EQ(row.finite, count);
      for (const float found : {row.mean, row.min, row.max, row.sample}) EXPECT_EQ(bits_of(found), bits_of(v));
      EXPECT_EQ(row.sse, 0);
      EXPECT_EQ(row.residual, 0);
    }
  }
}

TEST(LeafSummary, OneValueBesideNaNIsUniform) {
  std::vector<float> values(512, -0.0F);
  values[0] = kNaN;
  values[511] = -kInf;
  const LeafRow row = summarize_leaf(values, 0);
  EXPECT_TRUE(row.uniform());
  EXPECT_EQ(row.finite, 510U);
  EXPECT_EQ(bits_of(row.mean), bits_of(-0.0F));
  EXPECT_TRUE(std::isnan(row.sample));
}

TEST(LeafSummary, ZerosOfBothSignsAreNotUniformAndMeanZero) {
  std::vector<float> values(512, -0.0F);
  values[511] = 0.0F;
  const LeafRow row = summarize_leaf(values, 3);
  EXPECT_FALSE(row.uniform());
  EXPECT_EQ(row.mean, 0.0F);
  EXPECT_EQ(row.sse, 0);
  EXPECT_EQ(bits_of(row.sample), bits_of(-0.0F));
}

TEST(LeafSummary, SumsStayExactAroundOneHundredMillion) {
  // One ulp of 1e8 is 8. The source itself has lost the signal of 1e-3, and the sums stay exact.
  std::vector<float> values(512, 1e8F + 1e-3F);
  EXPECT_EQ(summarize_leaf(values, 0).mean, 1e8F);
  for (std::size_t i = 0; i < 512; ++i) values[i] = 1e8F + (i % 2 == 0 ? 8.0F : 0.0F);
  const LeafRow row = summarize_leaf(values, 0);
  EXPECT_EQ(row.mean, 1e8F);  // 1e8 + 4 rounds to even
  EXPECT_EQ(row.residual, 2048.0F);
  EXPECT_EQ(row.sse, 256 * 64.0);
  EXPECT_EQ(row.sse_about(1e8F + 8), 256 * 64.0);
  EXPECT_EQ(row.sse_about(0), 256 * 1e16 + 256 * 100000008.0 * 100000008.0);
}

TEST(LeafSummary, SamplePositionIsInRangeAndSpread) {
  for (const std::size_t count : {1U, 2U, 27U, 512U}) {
    std::vector<int> hits(count);
    for (std::int64_t i = 0; i < 20000; ++i) {
      const std::size_t at = sample_position(i, count);
      ASSERT_LT(at, count);
      ++hits[at];
    }
    // The hits stay within six standard deviations of an even distribution.
    const double mean = 20000.0 / static_cast<double>(count);
    for (const int n : hits) EXPECT_NEAR(n, mean, 6 * std::sqrt(mean) + 1e-9);
  }
  EXPECT_EQ(sample_position(123456, 512), sample_position(123456, 512));
}

}  // namespace
}  // namespace weir::leaf_summary_test
